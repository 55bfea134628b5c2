#include "elastogear/base/rotation.h"

#include <Eigen/Geometry>

namespace elastogear {

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d S;
  S << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return S;
}

Eigen::Matrix3Xd cross(const Eigen::Vector3d& a, const Eigen::Matrix3Xd& columns) {
  return skew(a) * columns;
}
Eigen::Matrix3Xd cross(const Eigen::Matrix3Xd& columns, const Eigen::Vector3d& b) {
  return -skew(b) * columns;
}

Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& psi) {
  const double angle = psi.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, psi / angle).toRotationMatrix();
}

Eigen::Matrix3d cayley(const Eigen::Vector3d& psi) {
  const Eigen::Matrix3d S = skew(psi);
  return Eigen::Matrix3d::Identity() + (S + 0.5 * S * S) / (1 + 0.25 * psi.squaredNorm());
}

Eigen::Matrix3d cayley_tangent(const Eigen::Vector3d& psi) {
  return (Eigen::Matrix3d::Identity() - 0.5 * skew(psi)) / (1 + 0.25 * psi.squaredNorm());
}

Eigen::Matrix3d orthonormalised(const Eigen::Matrix3d& R) { return 1.5 * R - 0.5 * R * R.transpose() * R; }

}  // namespace elastogear
