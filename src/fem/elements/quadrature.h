#pragma once
// Quadrature rules on the reference cells. Sources: G. R. Cowper, "Gaussian quadrature formulas for
// triangles", Int. J. Numer. Meth. Eng. 7 (1973) 405-408 (triangle, 3 and 6 points); A. H. Stroud,
// "Approximate calculation of multiple integrals" (1971), formulas T3:2-1 and T3:5-1 (tetrahedron, 4 and 15
// points).

#include <Eigen/Core>

namespace elastogear::fem {

struct Rule {
  Eigen::Matrix3Xd xi;  ///< one point per column
  Eigen::VectorXd w;    ///< weights; their sum is the volume of the reference cell
};

/// n x n x n Gauss points on [-1, 1]^3, n = 2 or 3: exact to degree 2n - 1 in each coordinate.
Rule hexahedron_rule(int n);

/// xi, eta, zeta >= 0, xi + eta + zeta <= 1. 1, 4 or 15 points: exact to degree 1, 2, 5.
Rule tetrahedron_rule(int n_points);

/// Triangle (xi, eta >= 0, xi + eta <= 1; 1, 3 or 6 points: degree 1, 2, 4) times [-1, 1] (2 or 3 Gauss
/// points).
Rule wedge_rule(int n_triangle, int n_line);

}  // namespace elastogear::fem
