#pragma once
// Symmetric tensors by their six numbers xx yy zz xy yz xz.

#include <Eigen/Core>

namespace elastogear {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The symmetric matrix with the entries xx yy zz xy yz xz.
inline Eigen::Matrix3d symmetric(const Eigen::Ref<const Vector6>& t) {
  Eigen::Matrix3d T;
  T << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
  return T;
}

/// The entries xx yy zz xy yz xz of a symmetric matrix.
inline Vector6 six_entries(const Eigen::Matrix3d& T) {
  return {T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2)};
}

}  // namespace elastogear
