#include "elastogear/body/joint.h"

#include <Eigen/Geometry>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::body {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Turned about the joint's point, then moved.
Placement about_point(const Joint& joint, const Eigen::Matrix3d& turn, const Vector3d& move) {
  return {joint.r_WB0 + joint.R_WB0 * (joint.point - turn * joint.point + move), joint.R_WB0 * turn};
}

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
    case JointType::spherical:
      return 3;
    case JointType::free:
      return 6;
  }
  fail("unknown joint type");
}

const std::vector<std::string>& joint_names() {
  static const std::vector<std::string> names = {"fixed",       "revolute",  "prismatic",
                                                 "cylindrical", "spherical", "free"};
  return names;
}

bool has_rotation_axis(JointType type) {
  return type == JointType::revolute || type == JointType::cylindrical;
}
bool has_translation_axis(JointType type) {
  return type == JointType::prismatic || type == JointType::cylindrical;
}
bool has_rotation_vector(JointType type) { return type == JointType::spherical || type == JointType::free; }

bool is_angle(JointType type, Eigen::Index i) {
  if (has_rotation_vector(type)) return i >= coordinate_count(type) - 3;
  return has_rotation_axis(type) && i == 0;
}

Placement placement(const Joint& joint, const Eigen::VectorXd& s) {
  if (joint.type == JointType::free) return {s.head<3>(), joint.R_WB0 * cayley(s.tail<3>())};
  if (joint.type == JointType::fixed) return {joint.r_WB0, joint.R_WB0};
  if (joint.type == JointType::spherical) return about_point(joint, cayley(s), Vector3d::Zero());
  const Vector3d axis = joint.axis.normalized();
  const double angle = has_rotation_axis(joint.type) ? s[0] : 0,
               slid = has_translation_axis(joint.type) ? s[s.size() - 1] : 0;
  return about_point(joint, rotation_matrix(angle * axis), slid * axis);
}

MotionSubspace motion_subspace(const Joint& joint) {
  const int n_s = coordinate_count(joint.type);
  if (n_s == 0 || n_s == 6) return MotionSubspace::Identity(6, n_s);
  require(joint.point.allFinite(), "joint point (", joint.point.transpose(), ") must be finite");
  MotionSubspace H = MotionSubspace::Zero(6, n_s);
  if (joint.type == JointType::spherical) {
    H << skew(joint.point), Eigen::Matrix3d::Identity();
    return H;
  }
  const double length = joint.axis.norm();
  require(std::isfinite(length) && length > 0, "joint axis (", joint.axis.transpose(),
          ") must be finite and not zero");
  const Vector3d axis = joint.axis / length;
  if (has_rotation_axis(joint.type)) H.col(0) << joint.point.cross(axis), axis;
  if (has_translation_axis(joint.type)) H.col(n_s - 1) << axis, Vector3d::Zero();
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
  if (joint.type == JointType::spherical) {
    d.theta = cayley_tangent(m.s);
    d.r = cross(joint.point, d.theta);
  }
  return d;
}

Joint rebased(const Joint& joint, const Eigen::VectorXd& s) {
  Joint result = joint;
  if (!has_rotation_vector(joint.type)) return result;
  result.R_WB0 = orthonormalised(placement(joint, s).R_WB);
  result.r_WB0 += (joint.R_WB0 - result.R_WB0) * joint.point;
  return result;
}

}  // namespace elastogear::body
