#pragma once
// The elastic block D = shift_a M_r + shift_v D_r + K_r - sum_p c_p K_p of one body's effective matrix, with
// the shares c_p of the parts that relax (docs/theory, Eq. (3.24)), its exact inverse,
// and the compliance E' D^-1 E that the joint and contact columns E see.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/base/petsc.h"
#include "elastogear/body/equations.h"

namespace elastogear::dynamics {

/// The columns E = [U, Phi(marker)', Phi(node)'], n_q x n_e, through which joint, markers and contact reach
/// the elastic coordinates. U of body/tangent.h and the markers (six columns each) do not change; three
/// columns belong to each surface node.
class BorderColumns {
 public:
  /// markers: n_q x 6 n_m, or empty.
  explicit BorderColumns(const body::Equations& eq, const Eigen::MatrixXd& markers = {});

  Eigen::Index n_u() const { return U_.cols(); }
  Eigen::Index size(const std::vector<int>& node) const;
  Eigen::MatrixXd project(const std::vector<int>& node, const Eigen::MatrixXd& X) const;  ///< E' X
  Eigen::VectorXd expand(const std::vector<int>& node, const Eigen::VectorXd& c) const;   ///< E c
  const Eigen::MatrixXd& U() const { return U_; }
  Eigen::MatrixXd node_columns(const std::vector<int>& node) const;  ///< Phi(node)', n_q x 3 n_node
  /// The elastic coordinates that are displacements of the node; -1 for those that are none.
  std::array<int, 3> coordinates(int node) const;

 private:
  const model::BasisRows* Phi_;
  Eigen::MatrixXd U_;  // U, then the markers'
};

/// D factorised once per pair of shifts: a division when the basis is modal, else a sparse Cholesky
/// factorisation (PETSc KSP, prefix "elastic_", MUMPS by default). Another preconditioner, as algebraic
/// multigrid, gets the body's rigid fields as near-null space; the inverse is then that of a matrix near D
/// and must be linear (no Krylov method without a fixed number of iterations). The body must outlive the
/// block.
class ElasticBlock {
 public:
  explicit ElasticBlock(const body::Equations& eq, const Eigen::MatrixXd& markers = {});

  /// Is D^-1 exact but for roundoff? Otherwise what it is used for is a preconditioner.
  bool is_exact() const { return exact_; }
  /// Throws Error when D is not positive definite. Does nothing when the shifts are those in force.
  /// following: c_p of each relaxing part of the body; empty: none follows.
  void set_shifts(double shift_v, double shift_a, const Eigen::VectorXd& following = {});
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;  ///< D x
  Eigen::MatrixXd solve(const Eigen::MatrixXd& Y) const;     ///< D^-1 Y
  /// D^-1 y, within 1e-6 of y; without a solution where y loads nodes whose columns are kept, and no others.
  Eigen::VectorXd solve_load(const Eigen::VectorXd& y) const;
  /// E' D^-1 E for the given nodes, from columns kept since the shifts last changed: n_e x n_e.
  std::shared_ptr<const Eigen::MatrixXd> compliance(const std::vector<int>& node);
  /// D^-1 E c for nodes whose compliance was asked for; without a solution where its columns are kept.
  Eigen::VectorXd response(const std::vector<int>& node, const Eigen::VectorXd& c) const;
  const BorderColumns& columns() const { return columns_; }
  /// To be called between two solves; what it throws leaves the block without kept columns.
  void on_solve(std::function<void()> pulse) { pulse_ = std::move(pulse); }
  /// Shifts and the order in which nodes came, on which the roundoff of the kept columns depends.
  void serialize(Archive& archive);

 private:
  void make_solver();
  void factorise();
  void attach_rigid_fields();
  void reset_compliance();
  void add_to_compliance(const std::vector<int>& node);
  Eigen::MatrixXd gathered(const std::vector<int>& node) const;

  const model::ElasticBody* body_;
  Eigen::SparseMatrix<double> D_r_;
  BorderColumns columns_;
  double shift_v_ = std::numeric_limits<double>::quiet_NaN(), shift_a_ = shift_v_;  // none yet
  Eigen::VectorXd following_;
  bool diagonal_ = false, exact_ = true;
  std::function<void()> pulse_;
  Eigen::VectorXd inverse_;  // of a diagonal D
  Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt> D_;
  UniqueMat D_mat_;  // borrows D_'s arrays
  UniqueKSP ksp_;
  Eigen::MatrixXd rigid_;                          // of the near-null space, once needed
  std::vector<int> kept_;                          // nodes in the order of G_
  std::vector<std::vector<int>> batches_;          // of kept_, as they were added together
  std::vector<int> slot_;                          // surface node -> position in kept_, or -1
  Eigen::MatrixXd G_;                              // E' D^-1 E of the kept nodes
  std::vector<int> asked_;                         // nodes whose compliance was last asked for
  std::shared_ptr<const Eigen::MatrixXd> answer_;  // their compliance, or null
  Eigen::MatrixXd U_response_;                     // D^-1 U
  std::vector<Eigen::MatrixX3d> response_;  // D^-1 Phi(node)' of the first kept nodes, unless D is diagonal
  std::vector<std::array<int, 3>> coordinate_;  // of the same nodes
};

}  // namespace elastogear::dynamics
