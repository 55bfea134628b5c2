#include "elastogear/body/marker.h"

#include <Eigen/Geometry>

#include "elastogear/base/rotation.h"

namespace elastogear::body {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// The marker in its body, components in B.
struct InBody {
  Vector3d x_B = Vector3d::Zero(), u_dot = Vector3d::Zero(), u_ddot = Vector3d::Zero();
  Vector3d theta = Vector3d::Zero(), theta_dot = Vector3d::Zero();  // elastic rotation, Cayley's map
  Matrix3d T_B = Matrix3d::Identity();                              // angular velocity T_B theta'

  double scale() const { return 1 + 0.25 * theta.squaredNorm(); }
};

InBody in_body(const model::Marker* marker, const Motion& m) {
  InBody e;
  if (!marker) return e;
  const Vector6 u = model::multiply(marker->Phi, m.q), u_dot = model::multiply(marker->Phi, m.q_dot);
  e.x_B = marker->X + u.head<3>();
  e.u_dot = u_dot.head<3>();
  e.u_ddot = Vector6(model::multiply(marker->Phi, m.q_ddot)).head<3>();
  e.theta = u.tail<3>();
  e.theta_dot = u_dot.tail<3>();
  e.T_B = cayley_tangent(e.theta).transpose();
  return e;
}

// Changes of the frame's v and of v + w x x_B + u' with s; the second without the turning of the frame.
Matrix3Xd rate_of_frame(const Equations& eq, const FrameMotion& f, const FrameDerivative& d, double shift_v) {
  if (eq.joint.type != JointType::free) return shift_v * eq.H.topRows<3>();
  return shift_v * d.r - cross(d.theta, f.v);
}

}  // namespace

MarkerMotion marker_motion(const Equations& eq, const model::Marker* marker, const Motion& m) {
  const auto [r, R] = placement(eq.joint, m.s);
  const FrameMotion f = frame_motion(eq, m);
  const InBody e = in_body(marker, m);
  const Vector3d w = f.w;
  MarkerMotion motion;
  motion.x = r + R * e.x_B;
  motion.R = R * cayley(e.theta);
  motion.v = R * (f.v + w.cross(e.x_B) + e.u_dot);
  motion.w = R * (w + e.T_B * e.theta_dot);
  motion.a = R * (f.a() + f.alpha.cross(e.x_B) + w.cross(w.cross(e.x_B) + 2 * e.u_dot) + e.u_ddot);
  return motion;
}

Force marker_force(const Equations& eq, const model::Marker* marker, const Motion& m, const Wrench& wrench) {
  const Matrix3d R_BW = placement(eq.joint, m.s).R_WB.transpose();
  const InBody e = in_body(marker, m);
  const Vector3d f = R_BW * wrench.head<3>(), moment = R_BW * wrench.tail<3>();
  Force h;
  h.s = eq.H.topRows<3>().transpose() * f + eq.H.bottomRows<3>().transpose() * (e.x_B.cross(f) + moment);
  if (!marker) {
    h.q.setZero(eq.n_q());
    return h;
  }
  Vector6 on_Phi;
  on_Phi << f, e.T_B.transpose() * moment;
  h.q = model::multiply_transposed(marker->Phi, on_Phi);
  return h;
}

MarkerDerivative marker_derivative(const Equations& eq, const model::Marker* marker, const Motion& m,
                                   const Shifts& shift) {
  const Matrix3d R = placement(eq.joint, m.s).R_WB;
  const FrameMotion f = frame_motion(eq, m);
  const FrameDerivative d = frame_derivative(eq.joint, eq.H, {m.s, m.s_dot, m.s_ddot}, shift);
  const InBody e = in_body(marker, m);
  const Matrix3Xd H_v = eq.H.topRows<3>(), H_w = eq.H.bottomRows<3>();
  const Vector3d v = f.v + f.w.cross(e.x_B) + e.u_dot, w = f.w + e.T_B * e.theta_dot;
  MarkerDerivative D;
  D.by_s.resize(12, eq.n_s());
  D.by_s.topRows<3>() = R * (d.r + cross(d.theta, e.x_B));
  D.by_s.middleRows<3>(3) = R * d.theta;
  D.by_s.middleRows<3>(6) = R * (cross(d.theta, v) + rate_of_frame(eq, f, d, shift.v) + cross(d.w, e.x_B));
  D.by_s.bottomRows<3>() = R * (cross(d.theta, w) + d.w);
  const Matrix3d dT =
      -(0.5 * skew(e.theta_dot) + 0.5 * e.T_B * e.theta_dot * e.theta.transpose()) / e.scale();
  D.by_q.setZero();
  D.by_q.topLeftCorner<3, 3>() = R;
  D.by_q.block<3, 3>(3, 3) = R * e.T_B;
  D.by_q.block<3, 3>(6, 0) = R * (skew(f.w) + shift.v * Matrix3d::Identity());
  D.by_q.block<3, 3>(9, 3) = R * (dT + shift.v * e.T_B);
  D.virtual_s.resize(6, eq.n_s());
  D.virtual_s << R * (H_v + cross(H_w, e.x_B)), R * H_w;
  return D;
}

WrenchStiffness wrench_stiffness(const Equations& eq, const model::Marker* marker, const Motion& m,
                                 const Wrench& wrench) {
  const Matrix3d R_BW = placement(eq.joint, m.s).R_WB.transpose();
  const InBody e = in_body(marker, m);
  const Vector3d f = R_BW * wrench.head<3>(), moment = R_BW * wrench.tail<3>();
  const Matrix3Xd H_v = eq.H.topRows<3>(), H_w = eq.H.bottomRows<3>();
  const Matrix3Xd theta = frame_derivative(eq.joint, eq.H, {m.s, m.s_dot, m.s_ddot}, {0, 0}).theta;
  const Matrix3Xd df = cross(theta, f), dm = cross(theta, moment);
  WrenchStiffness K;
  K.C = (H_v + cross(H_w, e.x_B)).transpose() * df + H_w.transpose() * dm;
  K.rho.setZero(6, eq.n_s());
  K.rho.topRows<3>() = -cross(f, H_w);
  K.beta.resize(6, eq.n_s());
  K.beta << df, e.T_B.transpose() * dm;
  const Vector3d on_theta = e.T_B.transpose() * moment;
  K.Z = -(0.5 * skew(moment) - 0.5 * on_theta * e.theta.transpose()) / e.scale();
  return K;
}

}  // namespace elastogear::body
