#pragma once
// The drawing of a drive: two sections of its meshes in place, and its numbers.

#include <string>

#include "app/gear/drive.h"

namespace elastogear::app {

/// Writes an SVG file in mm. meshes: of the members, in their order. Left: the section through the origin
/// across the world's z axis, right: that through the axis of the first pair and its line of centres.
void write_drawing(const std::string& path, const std::string& title, const Drive& drive,
                   const std::vector<mesh::Mesh>& meshes);

}  // namespace elastogear::app
