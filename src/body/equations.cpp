#include "elastogear/body/equations.h"

#include "elastogear/base/rotation.h"

namespace elastogear::body {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Inertia of the frozen body about the BRF origin: [m I, -S~; S~, J] with the first moment S.
Matrix6 rigid_inertia(double m, const Eigen::Vector3d& first_moment, const Eigen::Matrix3d& J) {
  Matrix6 M;
  M << m * Eigen::Matrix3d::Identity(), -skew(first_moment), skew(first_moment), J;
  return M;
}

Eigen::MatrixXd joint_inertia_derivatives(const model::Inertia& inertia, const MotionSubspace& H) {
  const Eigen::Index n_s = H.cols(), n_q = inertia.C_l.rows();
  Eigen::MatrixXd M_ss_1(n_s * n_s, n_q);
  for (int k = 0; k < n_q; ++k) {
    const Matrix6 M_k = rigid_inertia(0, inertia.C_l.row(k).transpose(), model::J_1(inertia, k));
    const Eigen::MatrixXd projected = H.transpose() * M_k * H;
    M_ss_1.col(k) = projected.reshaped();
  }
  return M_ss_1;
}

}  // namespace

Equations make_equations(std::shared_ptr<const model::ElasticBody> body, const Joint& joint,
                         InertiaLevel level) {
  Equations eq;
  const model::Inertia& inertia = body->inertia;
  eq.joint = joint;
  eq.H = motion_subspace(joint);
  eq.M_ss = eq.H.transpose() * rigid_inertia(inertia.m, inertia.m * inertia.c, inertia.J) * eq.H;
  eq.M_sq = eq.H.topRows<3>().transpose() * inertia.C_l.transpose() +
            eq.H.bottomRows<3>().transpose() * inertia.C_r.transpose();
  eq.M_ss_1 = joint_inertia_derivatives(inertia, eq.H);
  if (level == InertiaLevel::constant) eq.M_ss_1.setZero();
  eq.D_r = body->alpha * body->M_r + body->beta * body->K_r;
  eq.body = std::move(body);
  return eq;
}

Eigen::MatrixXd joint_inertia_change(const Equations& eq, const Eigen::VectorXd& x) {
  const Eigen::VectorXd change = eq.M_ss_1 * x;
  return change.reshaped(eq.n_s(), eq.n_s());
}

Eigen::MatrixXd joint_inertia(const Equations& eq, const Eigen::VectorXd& q) {
  return eq.M_ss + joint_inertia_change(eq, q);
}

Force inertia_force(const Equations& eq, const Motion& m) {
  return {joint_inertia(eq, m.q) * m.s_ddot + eq.M_sq * m.q_ddot,
          eq.M_sq.transpose() * m.s_ddot + eq.body->M_r * m.q_ddot};
}

Force quadratic_force(const Equations& eq, const Motion& m) {
  const Eigen::MatrixXd s_dot_squared = m.s_dot * m.s_dot.transpose();
  return {-joint_inertia_change(eq, m.q_dot) * m.s_dot,
          0.5 * (eq.M_ss_1.transpose() * s_dot_squared.reshaped())};
}

Force inner_force(const Equations& eq, const Motion& m) {
  return {Eigen::VectorXd::Zero(eq.n_s()), eq.D_r * m.q_dot + eq.body->K_r * m.q};
}

double kinetic_energy(const Equations& eq, const Motion& m) {
  return 0.5 * m.s_dot.dot(joint_inertia(eq, m.q) * m.s_dot) + m.s_dot.dot(eq.M_sq * m.q_dot) +
         0.5 * m.q_dot.dot(eq.body->M_r * m.q_dot);
}

double elastic_energy(const Equations& eq, const Motion& m) { return 0.5 * m.q.dot(eq.body->K_r * m.q); }

double dissipation(const Equations& eq, const Eigen::VectorXd& q_dot) { return q_dot.dot(eq.D_r * q_dot); }

}  // namespace elastogear::body
