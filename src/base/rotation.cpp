#include "elastogear/base/rotation.h"

#include <Eigen/Geometry>

namespace elastogear {

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d S;
  S << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return S;
}

Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& psi) {
  const double angle = psi.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, psi / angle).toRotationMatrix();
}

}  // namespace elastogear
