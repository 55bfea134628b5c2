#pragma once
// Isotropic elasticity from shape-function gradients alone: the part that all solid elements share.

#include <Eigen/Core>

#include "elastogear/fem/material.h"

namespace elastogear::fem {

/// Stiffness of n functions in three directions from their gradients at n_p points,
///   K[(a,i),(b,j)] = sum_p w_p (lambda g_ai g_bj + mu g_aj g_bi + mu delta_ij g_a . g_b),
/// read off the one product T = G G'. G: 3n x n_p, column p = sqrt(w_p) (g_1x g_1y g_1z g_2x ...).
template <int n, int n_p>
Eigen::Matrix<double, 3 * n, 3 * n> isotropic_stiffness(const Eigen::Matrix<double, 3 * n, n_p>& G,
                                                        const Lame& material) {
  const Eigen::Matrix<double, 3 * n, 3 * n> T = G * G.transpose();
  Eigen::Matrix<double, 3 * n, 3 * n> K;
  for (int b = 0; b < n; ++b)
    for (int a = 0; a < n; ++a) {
      const Eigen::Matrix3d block = T.template block<3, 3>(3 * a, 3 * b);
      K.template block<3, 3>(3 * a, 3 * b) = material.lambda * block + material.mu * block.transpose() +
                                             material.mu * block.trace() * Eigen::Matrix3d::Identity();
    }
  return K;
}

/// Stress (xx yy zz xy yz xz) per unit amplitude of n functions in three directions at one point with
/// gradients g: 6 x 3n.
template <int n>
Eigen::Matrix<double, 6, 3 * n> isotropic_stress(const Eigen::Matrix<double, 3, n>& g, const Lame& material) {
  const double mu = material.mu;
  Eigen::Matrix<double, 6, 3 * n> DB;
  for (int a = 0; a < n; ++a) {
    const double x = g(0, a), y = g(1, a), z = g(2, a);
    Eigen::Matrix<double, 6, 3> block;
    block << 2 * mu * x, 0, 0, 0, 2 * mu * y, 0, 0, 0, 2 * mu * z, mu * y, mu * x, 0, 0, mu * z, mu * y,
        mu * z, 0, mu * x;
    block.template topRows<3>().rowwise() += material.lambda * g.col(a).transpose();
    DB.template middleCols<3>(3 * a) = block;
  }
  return DB;
}

}  // namespace elastogear::fem
