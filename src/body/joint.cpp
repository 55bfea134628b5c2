#include "elastogear/body/joint.h"

#include <Eigen/Geometry>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::body {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Every cross product a x of the columns.
Matrix3Xd cross(const Vector3d& a, const Matrix3Xd& columns) { return skew(a) * columns; }

}  // namespace

int coordinate_count(JointType type) {
  switch (type) {
    case JointType::fixed:
      return 0;
    case JointType::revolute:
    case JointType::prismatic:
      return 1;
    case JointType::cylindrical:
      return 2;
    case JointType::free:
      return 6;
  }
  fail("unknown joint type");
}

const std::vector<std::string>& joint_names() {
  static const std::vector<std::string> names = {"fixed", "revolute", "prismatic", "cylindrical", "free"};
  return names;
}

bool turns(JointType type) { return type == JointType::revolute || type == JointType::cylindrical; }
bool slides(JointType type) { return type == JointType::prismatic || type == JointType::cylindrical; }

Placement placement(const Joint& joint, const Eigen::VectorXd& s) {
  if (joint.type == JointType::free) return {s.head<3>(), joint.R_WB0 * cayley(s.tail<3>())};
  if (joint.type == JointType::fixed) return {joint.r_WB0, joint.R_WB0};
  const Vector3d axis = joint.axis.normalized();
  const double angle = turns(joint.type) ? s[0] : 0, slid = slides(joint.type) ? s[s.size() - 1] : 0;
  const Eigen::Matrix3d turn = rotation_matrix(angle * axis);
  return {joint.r_WB0 + joint.R_WB0 * (joint.point - turn * joint.point + slid * axis), joint.R_WB0 * turn};
}

MotionSubspace motion_subspace(const Joint& joint) {
  const int n_s = coordinate_count(joint.type);
  if (n_s == 0 || n_s == 6) return MotionSubspace::Identity(6, n_s);
  const double length = joint.axis.norm();
  require(std::isfinite(length) && length > 0, "joint axis (", joint.axis.transpose(),
          ") must be finite and not zero");
  require(joint.point.allFinite(), "joint point (", joint.point.transpose(), ") must be finite");
  const Vector3d axis = joint.axis / length;
  MotionSubspace H = MotionSubspace::Zero(6, n_s);
  if (turns(joint.type)) H.col(0) << joint.point.cross(axis), axis;
  if (slides(joint.type)) H.col(n_s - 1) << axis, Vector3d::Zero();
  return H;
}

FrameMotion frame_motion(const Joint& joint, const MotionSubspace& H, const JointMotion& m) {
  FrameMotion f;
  f.w = H.bottomRows<3>() * m.s_dot;
  f.alpha = H.bottomRows<3>() * m.s_ddot;
  if (joint.type == JointType::free) {
    const Eigen::Matrix3d R_BW = placement(joint, m.s).R_WB.transpose();
    f.v = R_BW * m.s_dot.head<3>();
    f.a_s = R_BW * m.s_ddot.head<3>();
    f.a_c.setZero();
  } else {
    f.v = H.topRows<3>() * m.s_dot;
    f.a_s = H.topRows<3>() * m.s_ddot;
    f.a_c = f.w.cross(f.v);
  }
  return f;
}

FrameDerivative frame_derivative(const Joint& joint, const MotionSubspace& H, const JointMotion& m,
                                 const Shifts& shift) {
  const FrameMotion f = frame_motion(joint, H, m);
  FrameDerivative d;
  d.r = H.topRows<3>();
  d.theta = H.bottomRows<3>();
  d.w = shift.v * d.theta;
  d.alpha = shift.a * d.theta;
  if (joint.type == JointType::free) {
    d.r.leftCols<3>() = placement(joint, m.s).R_WB.transpose();
    d.theta.rightCols<3>() = cayley_tangent(m.s.tail<3>());
    d.a = shift.a * d.r + cross(f.a_s, d.theta);
  } else {
    d.a = shift.a * d.r + shift.v * (cross(f.w, d.r) - cross(f.v, d.theta));
  }
  return d;
}

Joint rebased(const Joint& joint, const Eigen::VectorXd& s) {
  Joint result = joint;
  if (joint.type == JointType::free) result.R_WB0 = orthonormalised(placement(joint, s).R_WB);
  return result;
}

}  // namespace elastogear::body
