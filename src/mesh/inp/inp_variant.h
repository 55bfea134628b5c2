#pragma once
// Element types of Abaqus that are read as a neighbour of theirs.

#include <string>
#include <string_view>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// Note on an element type ("C3D20R", in capitals) that is not computed as its name says; empty when it is.
/// 8-node hexahedra follow the option element, so that of them only C3D8I, its default, has no note.
std::string variant_note(std::string_view element, CellType type);

}  // namespace elastogear::mesh
