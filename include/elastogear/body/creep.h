#pragma once
// Creep of what a modal basis leaves out of a viscoelastic body (docs/theory.md, section 2.9): contact forces
// f displace the nodes by w = R_0 f + D (psi - f) with the forces psi that f has grown to by creep,
//   psi - sum_i g_i eta_i = f,   eta_i' = (psi - eta_i)/tau_i,   eta_i(0) = 0   (Eq. (2.20)).

#include <Eigen/Core>

#include "elastogear/body/relaxation.h"

namespace elastogear::body {

/// psi, eta_1 .. eta_n as columns, 3 x (1 + n): those of the force on a node, N, or of any linear function of
/// forces, as of the displacement of a node by D, m. Without columns: zero.
using CreepState = Eigen::Matrix3Xd;

/// The series by which the residual displacement of a body creeps; without terms: not at all.
RelaxationLaw creep_law(const model::ElasticBody& body);
/// K_r after all relaxation, K_r - sum_p g_p K_p.
Eigen::MatrixXd long_term_stiffness(const model::ElasticBody& body);

/// How states go on within one step; the same for all nodes of a body.
class CreepLaw {
 public:
  /// Relative moduli of the one part of the law (1 x n), and times. A law without terms leaves psi = f.
  explicit CreepLaw(RelaxationLaw law);

  /// Does anything creep?
  bool creeps() const { return g_.size() > 0; }
  Eigen::Index n_columns() const { return 1 + g_.size(); }  ///< of a state
  /// sum_i g_i / (1 - sum_i g_i): psi - f after all relaxation, of a constant f.
  double long_term() const { return g_.sum() / (1 - g_.sum()); }
  /// From here on states are at this point of a step that begins at the states given, or have the moduli that
  /// do not depend on time.
  void set_point(Moduli moduli, const StepPoint& at);
  /// c / (1 - c): what psi - f grows by at once with f. Eq. (3.27).
  double at_once() const { return at_once_; }
  /// psi - f for f = 0. Eq. (3.27).
  Eigen::Vector3d lag(const CreepState& start) const;
  /// The state at the point, where the force is f.
  CreepState state(const CreepState& start, const Eigen::Vector3d& f) const;

  /// Twice the energy that springs keep, and what dashpots take between two states, of forces a and their
  /// displacements D a. Eqs. (3.28) and (3.29).
  double twice_energy(const CreepState& force, const CreepState& displaced) const;
  struct Pair {
    const CreepState &from, &to;
  };
  double loss(const Pair& force, const Pair& displaced) const;

 private:
  Eigen::Vector3d kept(const CreepState& start, Eigen::Index i) const;

  RelaxationLaw law_;
  Eigen::VectorXd g_;              // relative moduli
  Eigen::VectorXd c_, relaxed_;    // of each term at the point: c_i, alpha (1 - exp(-h_i))
  double at_once_ = 0, rise_ = 1;  // c / (1 - c), 1 / (1 - c)
};

}  // namespace elastogear::body
