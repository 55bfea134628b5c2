#pragma once
// Element types of Abaqus that are read as a neighbour of theirs.

#include <string>
#include <string_view>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// What of the element type ("C3D20R", in capitals) is not computed as it says; empty when all is. 8-node
/// hexahedra follow the option element, so that only C3D8I, its default, says nothing.
std::string variant_note(std::string_view element, CellType type);

}  // namespace elastogear::mesh
