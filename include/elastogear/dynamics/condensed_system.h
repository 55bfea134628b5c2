#pragma once
// The system that stays when the elastic coordinates are eliminated, docs/theory, Eq. (8.16): unknowns are
// the n_s joint coordinates x_s of all bodies and lambda = V'x of the r columns of contact and markers.
//
// Most columns of a contact are weak: k times the compliance that they see is small, as it is where a force
// turns. Where they are many, the system of the others, the leading ones, is factorised, and that of all is
// solved by GMRES with it, Eq. (8.16b). A factorisation of all columns takes its place should it not leave as
// little as is asked for.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <vector>

#include "elastogear/dynamics/column_runs.h"
#include "elastogear/dynamics/dense_lu.h"
#include "elastogear/dynamics/effective_matrix.h"

namespace elastogear::dynamics {

/// Where the joint coordinates of a body are among all, how many, and the compliance E'D^-1 E of its columns.
struct CondensedBody {
  Eigen::Index joint, n_s;
  std::shared_ptr<const Eigen::MatrixXd> G;  ///< n_e x n_e
};

/// Share of the contact forces by which a solution with factors is off.
inline constexpr double kAsFactorised = 1e-11;

/// solve() takes the matrix that was last set.
class CondensedSystem {
 public:
  /// Throws Error when the matrix is singular or not finite.
  void set(const EffectiveMatrix& A, std::vector<CondensedBody> bodies);
  /// right: [y_s - rho'p; L_V'p]; returns [x_s; lambda], n_s + r entries each. left: share of the contact
  /// forces that GMRES may leave.
  Eigen::VectorXd solve(const EffectiveMatrix& A, const Eigen::VectorXd& right,
                        double left = kAsFactorised) const;
  /// Are all columns factorised together?
  bool is_whole() const { return all_.has_value(); }
  /// Steps of GMRES in the last solution.
  int n_steps() const { return n_steps_; }

 private:
  Eigen::Index n_leading() const { return static_cast<Eigen::Index>(leading_.size()); }
  // A residual displacement with rows of its own, L_x, is part of the displacements, below the others.
  struct Body {
    Eigen::Index joint, n_s;
    std::shared_ptr<const Eigen::MatrixXd> compliance;  // n_d x n_e: G, and R below it with rows of its own
    Eigen::MatrixXd rho;                                // n_d x n_s
    Eigen::SparseMatrix<double> V_own = {};             // n_d x r: L_V and L_x below it, or empty
    ColumnRuns L_runs = {}, V_runs = {};                // of L and V
    Eigen::SparseMatrix<double> V_leading = {};         // n_d x l
    Eigen::MatrixXd response = {};                      // of [beta, L k_leading], n_d x (n_s + l)
  };
  static Body make_body(const BodyTerms& terms, CondensedBody given);
  const Eigen::SparseMatrix<double>& V(const EffectiveMatrix& A, std::size_t b) const;
  bool choose_leading(const EffectiveMatrix& A);
  void factorise_all(const EffectiveMatrix& A) const;
  void factorise_leading(const EffectiveMatrix& A);
  void add_response(const Body& body, const Eigen::VectorXd& small, Eigen::VectorXd& displacement) const;
  Eigen::VectorXd solve_leading(const EffectiveMatrix& A, const Eigen::VectorXd& right) const;
  Eigen::VectorXd moved_by(const EffectiveMatrix& A, const Eigen::VectorXd& forces) const;
  std::optional<Eigen::VectorXd> solve_by_steps(const EffectiveMatrix& A, const Eigen::VectorXd& right,
                                                double left) const;

  Eigen::Index n_s_ = 0;
  std::vector<Body> body_;
  std::vector<Eigen::Index> leading_;
  Eigen::SparseMatrix<double> k_leading_;  // r x l, rows of the leading columns alone
  Eigen::SparseMatrix<double> k_weak_;     // r x r, what else there is of k
  ColumnRuns weak_runs_;                   // of k_weak_
  Eigen::VectorXd weight_;                 // r, norms of the columns of L over all bodies
  DenseLu lu_;                             // of the leading columns
  mutable std::optional<DenseLu> all_;     // of all columns, once it is needed
  mutable int n_steps_ = 0;
};

}  // namespace elastogear::dynamics
