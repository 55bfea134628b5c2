#include "elastogear/body/joint.h"

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::body {

MotionSubspace motion_subspace(const Joint& joint) {
  if (joint.type == JointType::fixed) return MotionSubspace(6, 0);
  const double length = joint.axis.norm();
  require(std::isfinite(length) && length > 0, "joint axis (", joint.axis.transpose(),
          ") must be finite and not zero");
  MotionSubspace H = MotionSubspace::Zero(6, 1);
  H.bottomRows<3>() = joint.axis / length;
  return H;
}

Placement placement(const Joint& joint, const MotionSubspace& H, const Eigen::VectorXd& s) {
  const Eigen::Matrix<double, 6, 1> twist = H * s;
  return {joint.r_WB0 + joint.R_WB0 * twist.head<3>(), joint.R_WB0 * rotation_matrix(twist.tail<3>())};
}

}  // namespace elastogear::body
