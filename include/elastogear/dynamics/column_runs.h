#pragma once
// Products of a sparse matrix whose neighbouring columns have entries in the same rows, as those of a contact
// have.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace elastogear::dynamics {

/// Where the columns of a matrix have entries. Its values are those of the matrix that each call is given.
class ColumnRuns {
 public:
  ColumnRuns() = default;
  explicit ColumnRuns(const Eigen::SparseMatrix<double>& A);

  Eigen::VectorXd multiply(const Eigen::SparseMatrix<double>& A,
                           const Eigen::Ref<const Eigen::VectorXd>& x) const;  ///< A x
  /// x -= A' y
  void subtract_transposed(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& y,
                           Eigen::Ref<Eigen::VectorXd> x) const;

  /// Columns whose entries, in the same rows, lie one after the other.
  struct Run {
    Eigen::Index column, n_columns, entry, n_rows;
  };

 private:
  std::vector<Run> run_;
};

}  // namespace elastogear::dynamics
