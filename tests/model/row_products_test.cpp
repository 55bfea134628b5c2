#include "elastogear/model/row_products.h"

#include <gtest/gtest.h>

namespace elastogear::row_products_test {
using namespace model;

namespace {

using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kRoundoff = 1e-14;

// Lengths with and without numbers that no register takes.
TEST(RowProducts, are_those_of_matrices) {
  for (Eigen::Index n = 0; n < 70; ++n) {
    const Rows A = Rows::Random(3, n);
    const Eigen::VectorXd x = Eigen::VectorXd::Random(n), y = Eigen::VectorXd::Random(n);
    const Eigen::Vector3d f(0.3, -2, 0.7);
    const double error = kRoundoff * static_cast<double>(n);
    EXPECT_LE((three_products(A.data(), x.data(), n) - A * x).norm(), error) << n;
    EXPECT_LE((weighted_squares(A.data(), x.data(), n) - A * x.asDiagonal() * A.transpose()).norm(), error)
        << n;
    Eigen::VectorXd sum = y;
    add_three_rows(A.data(), f, sum.data(), n);
    EXPECT_LE((sum - (y + A.transpose() * f)).norm(), error) << n;
  }
}

// Steps that go on from a checkpoint are those of the whole run to the bit.
TEST(RowProducts, do_not_depend_on_where_rows_lie_in_memory) {
  constexpr Eigen::Index kMost = 40, kGaps = 20;
  const Eigen::Vector3d f(0.3, 0.7, -0.2);
  for (Eigen::Index n = 1; n <= kMost; ++n) {
    const Eigen::VectorXd rows = Eigen::VectorXd::Random(3 * n), x = Eigen::VectorXd::Random(n);
    Eigen::VectorXd h = x;
    add_three_rows(rows.data(), f, h.data(), n);
    const Eigen::Vector3d u = three_products(rows.data(), x.data(), n);
    for (Eigen::Index gap = 0; gap < kGaps; ++gap) {
      Eigen::VectorXd memory(4 * n + 2 * gap);
      memory.segment(gap, 3 * n) = rows;
      auto sum = memory.tail(n);
      sum = x;
      EXPECT_EQ(three_products(memory.data() + gap, x.data(), n), u) << n << " entries, gap " << gap;
      add_three_rows(memory.data() + gap, f, sum.data(), n);
      EXPECT_EQ(sum, h) << n << " entries, gap " << gap;
    }
  }
}

}  // namespace
}  // namespace elastogear::row_products_test
