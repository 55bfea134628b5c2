#pragma once
// The effective matrix A = shift_a dF/dA + shift_v dF/dV + dF/dU of the system and its exact inverse.
//
// Per body, with the columns E of BorderColumns,      A = [C, (E rho)'; E beta, D]  on [s; q],
// and over all bodies the low rank part of contact and markers + W k V', W = [W_s; E L], V = [V_s; E L_V] per
// body. With x_q = D^-1 (y_q - E (beta x_s + L k lambda)) and lambda = V'x a dense system of n_s + r unknowns
// stays:
//   [C - rho'G beta,  (W_s - rho'G L) k;  -V_s' + L_V'G beta,  I + L_V'G L k] [x_s; lambda]
//     = [y_s - rho'p; L_V'p]
// where G = E'D^-1 E and p = E'D^-1 y_q (docs/theory, Eqs. (8.11), (8.12) and (8.16)). V_s differs from
// W_s where coordinates are not the integrals of their rates (free joints), and both from W for forces that
// have no potential. The residual displacement w = -R (beta x_s + L k lambda) makes lambda = V'x +
// L_x'w, so that G + R takes the place of G, with L_x before R. At inertia level full A has further parts,
// which the products with A hold and the inverse leaves out: it is then a preconditioner.

#include <vector>

#include "elastogear/dynamics/condensed_system.h"
#include "elastogear/dynamics/effective_matrix.h"
#include "elastogear/dynamics/elastic_block.h"

namespace elastogear::dynamics {

/// A body, how many of its joint coordinates are unknown, and the columns of its markers, see BorderColumns.
struct SolverBody {
  const body::Equations* eq;
  Eigen::Index n_s;
  Eigen::MatrixXd markers = {};
};

/// Vectors are ordered body by body, [s; q] each.
class LowRankSolver {
 public:
  explicit LowRankSolver(const std::vector<SolverBody>& bodies);

  /// Are the blocks D inverted exactly, see ElasticBlock? Otherwise solve() is a preconditioner.
  bool is_exact() const;
  /// Factorises A. Throws Error when it is singular.
  void set(EffectiveMatrix A);
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;  ///< A x
  /// A^-1 y, without the parts of level full. left: of CondensedSystem::solve.
  Eigen::VectorXd solve(const Eigen::VectorXd& y, double left = kAsFactorised) const;
  /// To be called between two solves with the blocks D; it may throw.
  void on_solve(const std::function<void()>& pulse);
  /// Stores or restores the data that set() takes from earlier calls.
  void serialize(Archive& archive);

 private:
  struct Range {
    Eigen::Index s, n_s, n_q;  ///< first entry in the global vector, sizes
    Eigen::Index joint;        ///< first entry among all bodies' joint coordinates
  };
  Eigen::VectorXd contact_forces(const Eigen::VectorXd& x,
                                 const std::vector<Eigen::VectorXd>& projected) const;
  void add_second_order(std::size_t b, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  std::vector<const body::Equations*> eq_;
  std::vector<Range> range_;
  std::vector<ElasticBlock> block_;
  EffectiveMatrix A_;
  Eigen::Index n_s_ = 0;
  CondensedSystem condensed_;
};

}  // namespace elastogear::dynamics
