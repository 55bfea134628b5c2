#include "elastogear/body/equations.h"

#include <Eigen/Geometry>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/tensor.h"
#include "elastogear/body/deformed_inertia.h"

namespace elastogear::body {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Eigen::MatrixXd inertia_derivatives(const model::Inertia& inertia) {
  Eigen::MatrixXd J_1(inertia.S_1.cols(), 6);
  for (int k = 0; k < J_1.rows(); ++k) J_1.row(k) = six_entries(model::J_1(inertia, k));
  return J_1;
}

// D_r from the Rayleigh coefficients and the damping ratios of the modes: docs/theory, Eq. (2.4).
Eigen::SparseMatrix<double> damping_matrix(const model::ElasticBody& body) {
  Eigen::SparseMatrix<double> D_r(body.M_r.rows(), body.M_r.cols());
  if (body.alpha != 0 || body.beta != 0) D_r = body.alpha * body.M_r + body.beta * body.K_r;
  if (body.zeta.size() == 0) return D_r;
  const VectorXd d = 4 * std::numbers::pi * body.zeta.cwiseProduct(body.frequency);
  return D_r + Eigen::SparseMatrix<double>(d.asDiagonal());
}

// Lowers the level to linear where that is exact: without rotation or deformation there are no products of
// both.
InertiaLevel needed_level(const model::ElasticBody& body, const MotionSubspace& H, InertiaLevel level) {
  const bool simple = body.n_q() == 0 || (level == InertiaLevel::affine && H.cols() == 0);
  return level >= InertiaLevel::affine && simple ? InertiaLevel::linear : level;
}

VectorXd on_joint(const Equations& eq, const Vector3d& F_v, const Vector3d& F_w) {
  return eq.H.topRows<3>().transpose() * F_v + eq.H.bottomRows<3>().transpose() * F_w;
}

// [m a; S x a; C_l a]: inertia of an accelerated frame that does not turn; its last part on y.
Force of_acceleration(const Equations& eq, const Vector3d& S, const Vector3d& a) {
  const model::Inertia& inertia = eq.inertia();
  return {on_joint(eq, inertia.m * a, S.cross(a)), inertia.C_l * a};
}

Force to_q(const Equations& eq, Force h) { return {std::move(h.s), from_inertia(eq, h.q)}; }

Force inertia_force(const Equations& eq, const Motion& m, const FrameMotion& f, const Shape& x) {
  const model::Inertia& inertia = eq.inertia();
  const VectorXd y_ddot = to_inertia(eq, m.q_ddot);
  Force h = of_acceleration(eq, x.S, f.a_s);
  h.s += on_joint(eq, f.alpha.cross(x.S) + inertia.C_l.transpose() * y_ddot,
                  x.J * f.alpha + project_C_r(eq, x, y_ddot));
  h.q += inertia.C_r * f.alpha;
  if (eq.second_order()) h.q += x.at_y.B * f.alpha;
  h = to_q(eq, std::move(h));
  h.q += eq.body->M_r * m.q_ddot;
  return h;
}

Force quadratic_force(const Equations& eq, const FrameMotion& f, const Shape& x) {
  const Vector3d w = f.w;
  Force h = of_acceleration(eq, x.S, -f.a_c);
  h.s -= on_joint(eq, w.cross(w.cross(x.S) + 2 * x.S_dot), w.cross(x.J * w + x.spin) + x.J_dot * w);
  if (eq.level == InertiaLevel::constant) return h;
  const Vector6 half_w_w = 0.5 * factor(w).transpose() * w;
  h.q += eq.J_1 * half_w_w;
  if (eq.second_order()) h.q += x.at_y.D * half_w_w - 2 * x.at_y_dot.B * w;
  return to_q(eq, std::move(h));
}

Force weight_force(const Equations& eq, const Motion& m, const Vector3d& g_W, const Vector3d& S) {
  const Vector3d g_B = placement(eq.joint, m.s).R_WB.transpose() * g_W;
  return to_q(eq, of_acceleration(eq, S, g_B));
}

}  // namespace

const std::vector<std::string>& inertia_level_names() {
  static const std::vector<std::string> names{"constant", "linear", "affine", "full"};
  return names;
}

Equations make_equations(std::shared_ptr<const model::ElasticBody> body, const Joint& joint,
                         InertiaLevel level) {
  Equations eq;
  eq.joint = joint;
  eq.H = motion_subspace(joint);
  eq.level = needed_level(*body, eq.H, level);
  require(
      eq.level != InertiaLevel::full || !body->inertia.S_2.empty(), "body '", body->name,
      "' lacks the second-order invariants that inertia level 'full' needs: reduce it with -invariants full");
  if (eq.level == InertiaLevel::affine) eq.affine = affine_part(body->inertia);
  eq.D_r = damping_matrix(*body);
  eq.body = std::move(body);
  eq.J_1 = level == InertiaLevel::constant ? Eigen::MatrixXd(eq.n_q(), 0) : inertia_derivatives(eq.inertia());
  return eq;
}

FrameMotion frame_motion(const Equations& eq, const Motion& m) {
  return frame_motion(eq.joint, eq.H, {m.s, m.s_dot, m.s_ddot});
}

Force inertia_force(const Equations& eq, const Motion& m) {
  return inertia_force(eq, m, frame_motion(eq, m), shape(eq, m));
}

Force quadratic_force(const Equations& eq, const Motion& m) {
  return quadratic_force(eq, frame_motion(eq, m), shape(eq, m));
}

Force gravity_force(const Equations& eq, const Motion& m, const Vector3d& g_W) {
  return weight_force(eq, m, g_W, first_moment(eq, to_inertia(eq, m.q)));
}

// Nothing moves the frame of a body without joint coordinates.
MotionForces motion_forces(const Equations& eq, const Motion& m, const Vector3d& g_W) {
  const Force none{VectorXd::Zero(eq.n_s()), VectorXd::Zero(eq.n_q())};
  const bool is_weightless = g_W.isZero(0);
  if (eq.n_s() == 0)
    return {{none.s, eq.body->M_r * m.q_ddot}, none, is_weightless ? none : gravity_force(eq, m, g_W)};
  const FrameMotion f = frame_motion(eq, m);
  const Shape x = shape(eq, m);
  return {inertia_force(eq, m, f, x), quadratic_force(eq, f, x),
          is_weightless ? none : weight_force(eq, m, g_W, x.S)};
}

Force inner_force(const Equations& eq, const Motion& m) {
  return {VectorXd::Zero(eq.n_s()), eq.D_r * m.q_dot + eq.body->K_r * m.q};
}

double kinetic_energy(const Equations& eq, const Motion& m) {
  const FrameMotion f = frame_motion(eq, m);
  const Shape x = shape(eq, m);
  const Vector3d S_dot = eq.inertia().C_l.transpose() * x.y_dot;
  return 0.5 * eq.body->inertia.m * f.v.squaredNorm() + f.v.dot(f.w.cross(x.S) + S_dot) +
         0.5 * f.w.dot(x.J * f.w) + f.w.dot(project_C_r(eq, x, x.y_dot)) +
         0.5 * m.q_dot.dot(eq.body->M_r * m.q_dot);
}

double elastic_energy(const Equations& eq, const Motion& m) { return 0.5 * m.q.dot(eq.body->K_r * m.q); }

double dissipation(const Equations& eq, const VectorXd& q_dot) { return q_dot.dot(eq.D_r * q_dot); }

double gravity_energy(const Equations& eq, const Motion& m, const Vector3d& g_W) {
  const Placement p = placement(eq.joint, m.s);
  return -g_W.dot(eq.body->inertia.m * p.r_WB + p.R_WB * first_moment(eq, to_inertia(eq, m.q)));
}

Momentum momentum(const Equations& eq, const Motion& m) {
  const FrameMotion f = frame_motion(eq, m);
  const Shape x = shape(eq, m);
  const Placement p = placement(eq.joint, m.s);
  const Vector3d S_dot = eq.inertia().C_l.transpose() * x.y_dot;
  const Vector3d linear = p.R_WB * (eq.body->inertia.m * f.v + f.w.cross(x.S) + S_dot);
  const Vector3d angular = p.R_WB * (x.S.cross(f.v) + x.J * f.w + project_C_r(eq, x, x.y_dot));
  return {linear, p.r_WB.cross(linear) + angular};
}

}  // namespace elastogear::body
