#pragma once
// The sides of cells that make up the surface of a mesh.

#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// The nodes of the sides that belong to one cell only, as cell_side_nodes has them: 3, 4, 6 or 8, corners
/// first.
std::vector<std::vector<int>> outer_sides(const Mesh& mesh);

/// Corners of a side with so many nodes.
inline int side_corners(std::size_t n_nodes) { return n_nodes % 3 == 0 ? 3 : 4; }

}  // namespace elastogear::mesh
