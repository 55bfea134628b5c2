#pragma once
// Creep of what a modal basis leaves out of a viscoelastic body (docs/theory, section 2.9): contact forces
// f displace the nodes by w = R_0 f + sum_j D_j (psi_j - f) with the forces psi_j that f has grown to by
// creep, psi of one law:
//   psi - sum_i g_i eta_i = f,   eta_i' = (psi - eta_i)/tau_i,   eta_i(0) = 0   (Eq. (2.20)).

#include <Eigen/Core>
#include <vector>

#include "elastogear/body/relaxation.h"

namespace elastogear::body {

/// psi, eta_1 .. eta_n of each law as columns, 3 x n_laws (1 + n): those of the force on a node, N, or of any
/// linear function of forces, as of the displacement of a node by D_j, m. Without columns: zero.
using CreepState = Eigen::Matrix3Xd;
using CreepColumns = Eigen::Ref<const Eigen::Matrix3Xd>;

/// The n_laws series by which the residual displacement of a body creeps, one in a viscoelastic body in one
/// ratio everywhere; none: not at all.
std::vector<RelaxationLaw> creep_laws(const model::ElasticBody& body);
/// C, (1 + n_laws) square, of a viscoelastic body in different ratios: R_k of the states (R_0 first) give
/// D_j = sum_k C_kj R_k. Eq. (2.23).
Eigen::MatrixXd creep_coefficients(const model::Flexibility& flexibility);
/// K_r of a state in which the share gamma_p of each part is gone, K_r - sum_p gamma_p K_p.
Eigen::MatrixXd relaxed_stiffness(const model::ElasticBody& body, const Eigen::VectorXd& share);

/// How states of one law go on within one step; the same for all nodes of a body.
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
  Eigen::Vector3d lag(const CreepColumns& start) const;
  /// The state at the point, where the force is f.
  CreepState state(const CreepColumns& start, const Eigen::Vector3d& f) const;
  /// (1 + n) square: the columns of a state without a force times this are those at the point.
  Eigen::MatrixXd free_step() const;

  /// Twice the energy that springs keep, and what dashpots take between two states, of forces a and their
  /// displacements D a. Eqs. (3.28) and (3.29).
  double twice_energy(const CreepColumns& force, const CreepColumns& displaced) const;
  struct Pair {
    CreepColumns from, to;
  };
  double loss(const Pair& force, const Pair& displaced) const;
  /// The same of many states, of which `gram` has the products of the columns of forces with those of
  /// displacements; the loss of forces that are zero all along from their states at the start to the point.
  double twice_energy(const Eigen::MatrixXd& gram) const;
  double free_loss(const Eigen::MatrixXd& gram) const;

 private:
  Eigen::Vector3d kept(const CreepColumns& start, Eigen::Index i) const;

  RelaxationLaw law_;
  Eigen::VectorXd g_;              // relative moduli
  Eigen::VectorXd c_, relaxed_;    // of each term at the point: c_i, alpha (1 - exp(-h_i))
  double at_once_ = 0, rise_ = 1;  // c / (1 - c), 1 / (1 - c)
};

/// All laws of a body, with their states side by side. The displacements D_j f that a state of displacements
/// takes are 3 x n_laws.
class CreepLaws {
 public:
  /// Laws that have the same number of terms; without any psi = f.
  explicit CreepLaws(const std::vector<RelaxationLaw>& laws);

  bool creeps() const { return !laws_.empty(); }
  Eigen::Index size() const { return static_cast<Eigen::Index>(laws_.size()); }  ///< n_laws
  Eigen::Index n_columns() const { return size() * n_each_; }                    ///< of a state
  const CreepLaw& operator[](Eigen::Index j) const { return laws_[static_cast<std::size_t>(j)]; }
  void set_point(Moduli moduli, const StepPoint& at);
  /// psi_j - f for f = 0, summed up over the laws.
  Eigen::Vector3d lag(const CreepState& start) const;
  /// sum_j psi_j of a state.
  Eigen::Vector3d sum(const CreepState& state) const;
  /// The state at the point, where the force is f; or the displacements by it are those of the columns.
  CreepState state(const CreepState& start, const Eigen::Vector3d& f) const;
  CreepState displaced_state(const CreepState& start, const CreepColumns& displaced) const;
  double twice_energy(const CreepState& force, const CreepState& displaced) const;
  struct Pair {
    const CreepState &from, &to;
  };
  double loss(const Pair& force, const Pair& displaced) const;

 private:
  CreepColumns columns(const CreepState& state, Eigen::Index j) const;

  std::vector<CreepLaw> laws_;
  Eigen::Index n_each_ = 0;
};

}  // namespace elastogear::body
