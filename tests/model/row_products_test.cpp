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

}  // namespace
}  // namespace elastogear::row_products_test
