#pragma once
// Small helpers with which worm and wheel build their meshes.

#include <array>
#include <string>

#include "elastogear/mesh/mesh.h"

namespace elastogear::gear {

/// Appends a hexahedron and returns its nodes' outward faces.
std::vector<mesh::Face> add_hex(mesh::Mesh& mesh, const std::array<int, 8>& nodes);

/// Appends a flank face to `flanks`, `<side>` and `<tooth>_<side>`.
void add_flank(mesh::Mesh& mesh, const mesh::Face& face, const std::string& tooth, const std::string& side);

/// Sorts the node sets and removes duplicates.
void sort_node_sets(mesh::Mesh& mesh);

/// "prefix_07": `i` (0-based) counted from 1, with as many digits as `n` has.
std::string numbered(const std::string& prefix, int i, int n);

/// Quotient rounded towards minus infinity.
inline int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace elastogear::gear
