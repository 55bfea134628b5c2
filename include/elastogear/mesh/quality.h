#pragma once
// Shape quality of hexahedra.

#include <optional>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// Quality over all cells of a mesh. The scaled Jacobian of a hexahedron is the smallest normalised triple
/// product of the edge vectors at its eight corners and of the principal axes at its centre (as in the
/// Verdict library): 1 for a brick, <= 0 when a corner is folded. Gauss Jacobians are det J at the 2 x 2 x 2
/// Gauss points.
struct Quality {
  double min_scaled_jacobian = 0;   ///< -
  double mean_scaled_jacobian = 0;  ///< -
  int worst_cell = -1;              ///< cell of min_scaled_jacobian
  double min_gauss_jacobian = 0;    ///< m^3, reference cube [-1, 1]^3
};

/// Scaled Jacobian of one cell, in [-1, 1]; 0 when an edge has no length.
double scaled_jacobian(const Mesh& mesh, int cell);

/// Smallest det J of one cell at its 2 x 2 x 2 Gauss points, m^3.
double gauss_jacobian(const Mesh& mesh, int cell);

/// Volume of one cell by the 2 x 2 x 2 rule (exact for trilinear hexahedra), m^3.
double volume(const Mesh& mesh, int cell);

/// Throws Error for a mesh without cells.
Quality quality(const Mesh& mesh);

/// First cell with a Gauss Jacobian that is not positive (or not finite).
std::optional<int> first_inverted_cell(const Mesh& mesh);

}  // namespace elastogear::mesh
