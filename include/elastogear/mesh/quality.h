#pragma once
// Shape quality of cells.

#include <optional>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// Quality over all cells of a mesh.
struct Quality {
  double min_scaled_jacobian = 0;   ///< -
  double mean_scaled_jacobian = 0;  ///< -
  int worst_cell = -1;              ///< cell of min_scaled_jacobian
  double min_jacobian = 0;          ///< m^3
};

/// Smallest triple product of the unit tangents of the edges that meet at a corner, over all corners (of
/// pyramids: of the base), divided by that of the regular cell, as in the Verdict library: 1 for a regular
/// cell (for every brick),
/// <= 0 when a corner is folded or, on a second-order cell, a midside node lies beyond a quarter of its edge;
/// 0 when an edge has no length. For hex8 also of the principal axes at its centre, for hex20 at its 27
/// integration points.
double scaled_jacobian(const Mesh& mesh, int cell);

/// Smallest det J of one cell, m^3: hex8 at its 2 x 2 x 2 Gauss points (reference cube [-1, 1]^3), others at
/// the corners, with edges of reference length 1, and hex20 also at its 3 x 3 x 3 Gauss points. The points
/// that elements integrate at are checked when a body is reduced.
double smallest_jacobian(const Mesh& mesh, int cell);

/// Volume of one hex8 by the 2 x 2 x 2 rule (exact for trilinear hexahedra), m^3; Error for other cells.
double volume(const Mesh& mesh, int cell);

/// Throws Error for a mesh without cells.
Quality quality(const Mesh& mesh);

/// First cell whose smallest Jacobian is not positive (or not finite).
std::optional<int> first_inverted_cell(const Mesh& mesh);

}  // namespace elastogear::mesh
