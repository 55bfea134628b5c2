#pragma once
// Small helpers with which worm and wheel build their meshes.

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::gear {

/// Appends a hexahedron and returns its nodes' outward faces.
std::vector<mesh::Face> add_hex(mesh::Mesh& mesh, const std::array<int, 8>& nodes);

/// Appends a flank face to `flanks`, `<side>` and `<tooth>_<side>`.
void add_flank(mesh::Mesh& mesh, const mesh::Face& face, const std::string& tooth, const std::string& side);

/// Throws Error when a count is not within 1..1000, or when about `cells` cells are too many for one mesh.
void check_counts(const std::string& body, std::initializer_list<int> counts, double cells);

/// Throws Error for growths of cells other than 0 and from 1 to 10. body: the gear's name.
void check_growth(const std::string& body, std::initializer_list<double> growth);

/// Throws Error, naming the place, when a cell is folded or its scaled Jacobian is below 0.25: the design
/// passes its checks, but not at these counts.
void check_cells(const mesh::Mesh& mesh, const std::string& body);

/// Sorts the node sets and removes duplicates.
void sort_node_sets(mesh::Mesh& mesh);

/// "prefix_07": `i` (0-based) counted from 1, with as many digits as `n` has.
std::string numbered(const std::string& prefix, int i, int n);

/// Quotient rounded towards minus infinity.
inline int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace elastogear::gear
