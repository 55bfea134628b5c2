#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "elastogear/dynamics/column_runs.h"

namespace elastogear::dynamics::column_runs_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double kRoundoff = 1e-14;

// Columns in runs of all sizes that have products of their own, of two that have none (2 and 5 rows), and
// without entries; rows not in line.
Sparse matrix_of_runs() {
  constexpr Index kRows = 40;
  std::vector<Eigen::Triplet<double>> entries;
  Index column = 0;
  for (const Index rows : {1, 3, 4, 12, 2, 5, 0, 12})
    for (const Index end = column + 1 + rows % 5; column < end; ++column)
      for (Index i = 0; i < rows; ++i)
        entries.emplace_back(static_cast<int>((3 * i + rows) % kRows), static_cast<int>(column),
                             std::sin(1.0 + static_cast<double>(7 * column + i)));
  Sparse A(kRows, column);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

TEST(ColumnRuns, multiply_as_the_matrix_does) {
  const Sparse A = matrix_of_runs();
  const VectorXd x = VectorXd::LinSpaced(A.cols(), -1, 2);
  EXPECT_LE((ColumnRuns(A).multiply(A, x) - A * x).norm(), kRoundoff * (A * x).norm());
}

TEST(ColumnRuns, subtract_what_the_transposed_gives) {
  const Sparse A = matrix_of_runs();
  const VectorXd y = VectorXd::LinSpaced(A.rows(), -1, 2);
  VectorXd x = VectorXd::LinSpaced(A.cols(), 3, 5);
  const VectorXd expected = x - A.transpose() * y;
  ColumnRuns(A).subtract_transposed(A, y, x);
  EXPECT_LE((x - expected).norm(), kRoundoff * expected.norm());
}

}  // namespace
}  // namespace elastogear::dynamics::column_runs_test
