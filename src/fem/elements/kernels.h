#pragma once
// Elasticity from shape-function gradients: the part that all solid elements share.

#include <Eigen/Core>
#include <span>

#include "elastogear/fem/material.h"

namespace elastogear::fem {

/// Stiffness of n functions in three directions from their gradients at n_p points,
///   K[(a,i),(b,j)] = sum_p w_p (lambda g_ai g_bj + mu g_aj g_bi + mu delta_ij g_a . g_b),
/// read off the one product T = G G'. G: 3n x n_p, column p = sqrt(w_p) (g_1x g_1y g_1z g_2x ...).
/// docs/theory, Eq. (1.4).
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

/// Strains (xx yy zz xy yz xz, gamma for shear) per unit amplitude of n functions in three directions at one
/// point with gradients g: 6 x 3n.
template <int n>
Eigen::Matrix<double, 6, 3 * n> strains(const Eigen::Matrix<double, 3, n>& g) {
  Eigen::Matrix<double, 6, 3 * n> B;
  for (int a = 0; a < n; ++a) {
    const double x = g(0, a), y = g(1, a), z = g(2, a);
    B.template middleCols<3>(3 * a) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
  }
  return B;
}

/// K = sum_p w_p B_p' H_p B_p for any elasticity H_p at n_p points; G as for isotropic_stiffness.
template <int n, int n_p>
Eigen::Matrix<double, 3 * n, 3 * n> general_stiffness(const Eigen::Matrix<double, 3 * n, n_p>& G,
                                                      std::span<const Matrix6> H) {
  Eigen::Matrix<double, 3 * n, 3 * n> K = Eigen::Matrix<double, 3 * n, 3 * n>::Zero();
  for (int p = 0; p < n_p; ++p) {
    const Eigen::Matrix<double, 3, n> g = G.col(p).template reshaped<Eigen::ColMajor>(3, n);
    const Eigen::Matrix<double, 6, 3 *n> B = strains<n>(g), HB = H[p] * B;
    K += B.transpose() * HB;
  }
  return K;
}

}  // namespace elastogear::fem
