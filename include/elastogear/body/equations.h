#pragma once
// Equations of motion of one elastic body in the floating frame of reference (the paper's Eq. 9, with the
// signs of docs/theory.md), in minimal coordinates: s of the joint, q of the basis.
//
//   T = 1/2 s'.M_ss(q) s' + s'.M_sq q' + 1/2 q'.M_r q'
//   M_ss(q) s'' + M_sq q''                 = -(dM_ss/dt) s'                       + h_s
//   M_sq' s''   + M_r q'' + D_r q' + K_r q = 1/2 d(s'.M_ss(q) s')/dq (s' fixed)   + h_q

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

#include "elastogear/body/joint.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::body {

/// What the inertia keeps of the deformation. constant: nothing. linear: c and J to first order in q; the
/// truncated T is the Lagrangian of the equations, so that they conserve energy exactly.
enum class InertiaLevel { constant, linear };

struct Equations {
  std::shared_ptr<const model::ElasticBody> body;
  Joint joint;
  MotionSubspace H;
  Eigen::MatrixXd M_ss;             ///< n_s x n_s, H' M_6 H at q = 0
  Eigen::MatrixXd M_sq;             ///< n_s x n_q, H' [C_l'; C_r']
  Eigen::MatrixXd M_ss_1;           ///< n_s^2 x n_q, column k: dM_ss/dq_k, column-major; zero when constant
  Eigen::SparseMatrix<double> D_r;  ///< n_q x n_q, alpha M_r + beta K_r

  Eigen::Index n_s() const { return H.cols(); }
  Eigen::Index n_q() const { return body->n_q(); }
};

struct Motion {
  Eigen::VectorXd s, s_dot, s_ddot;  ///< n_s; revolute: rad
  Eigen::VectorXd q, q_dot, q_ddot;  ///< n_q
};

/// Generalised force: power = s.s' + q.q'.
struct Force {
  Eigen::VectorXd s, q;
};

Equations make_equations(std::shared_ptr<const model::ElasticBody> body, const Joint& joint,
                         InertiaLevel level);

/// M_ss(q), n_s x n_s.
Eigen::MatrixXd joint_inertia(const Equations& eq, const Eigen::VectorXd& q);
/// sum_k x_k dM_ss/dq_k, n_s x n_s.
Eigen::MatrixXd joint_inertia_change(const Equations& eq, const Eigen::VectorXd& x);

Force inertia_force(const Equations& eq, const Motion& m);    ///< M(q) [s''; q'']
Force quadratic_force(const Equations& eq, const Motion& m);  ///< centrifugal and Coriolis, right-hand side
Force inner_force(const Equations& eq, const Motion& m);      ///< h_e = [0; D_r q' + K_r q]

double kinetic_energy(const Equations& eq, const Motion& m);            ///< J
double elastic_energy(const Equations& eq, const Motion& m);            ///< J, 1/2 q.K_r q
double dissipation(const Equations& eq, const Eigen::VectorXd& q_dot);  ///< W, q'.D_r q'

}  // namespace elastogear::body
