#pragma once
// The deformation by its best affine field (docs/theory, section 3.1): u ~ g + G X, nearest in the norm of
// the mass. Products of rotation and deformation need no more of it to first order.

#include "elastogear/model/elastic_body.h"

namespace elastogear::body {

/// Coordinates y = Y'q of the affine part: four for each direction, y[4 b + i], of orthonormal fields
/// (integral of rho f_i f_j dV = delta_ij) among 1, X_1, X_2, X_3.
struct AffinePart {
  Eigen::MatrixXd Y;       ///< n_q x 12
  model::Inertia inertia;  ///< with y in place of q; S_2, whose S^ab y = [y_b in place of y_a], stays empty
};

/// Fields without mass (bodies without extension in a direction) have coordinates zero. Eq. (3.11c).
AffinePart affine_part(const model::Inertia& inertia);

/// du_b/dX_a of the affine part, row 3 a + b, 9 x n_q; zero without extension in a direction.
Eigen::MatrixXd mean_gradient(const model::Inertia& inertia);

}  // namespace elastogear::body
