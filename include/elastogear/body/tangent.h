#pragma once
// Derivative of a body's inertia, quadratic and gravity forces (docs/theory, section 8.1). With the
// columns U through which the frame reaches q, [C_l, C_r, J_1] or those of the affine part,
//
//   d[F_s; F_q] = [C, (U rho)' + R_q; U beta + Q_s, sum_ab Gamma_ab S^ab] d[s; q],
//
// beside shift_a M_r + shift_v D_r + K_r. R_q and Q_s are those of level full, and else empty; Gamma is zero
// at the levels below affine, where S^ab is that of the affine part.

#include "elastogear/body/equations.h"

namespace elastogear::body {

struct Tangent {
  Eigen::MatrixXd C;          ///< n_s x n_s
  Eigen::MatrixXd beta, rho;  ///< n_u x n_s
  Eigen::MatrixXd R_q, Q_s;   ///< n_s x n_q, n_q x n_s
  Eigen::Matrix3d Gamma;
};

/// U, n_q x n_u: n_u = 12, at level constant 6, for fixed bodies 0.
Eigen::MatrixXd border(const Equations& eq);
/// Z of sum_ab Gamma_ab S^ab = U Z U', 12 x 12, at level affine; else, or when zero, empty.
Eigen::MatrixXd stiffness_in_border(const Equations& eq, const Eigen::Matrix3d& Gamma);

Tangent tangent(const Equations& eq, const Motion& m, const Eigen::Vector3d& g_W, const Shifts& shift);

}  // namespace elastogear::body
