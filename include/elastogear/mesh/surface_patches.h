#pragma once
// Nodes that share a face of the boundary with given ones, and the order of the cells there, for estimates of
// the error of stresses on free surfaces (docs/theory, section 1.7).

#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// For each of the nodes, itself and the nodes that share a face of the boundary with it, ascending.
std::vector<std::vector<int>> surface_patches(const Mesh& mesh, const std::vector<int>& nodes);

/// Degree of the displacements in the cells at each of the nodes: 2 where one of them has midside nodes,
/// else 1.
std::vector<int> cell_orders(const Mesh& mesh, const std::vector<int>& nodes);

}  // namespace elastogear::mesh
