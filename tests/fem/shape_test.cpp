#include "fem/elements/shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastogear/base/error.h"
#include "fem/elements/quadrature.h"
#include "other_cells.h"

namespace elastogear::shape_test {
namespace {

using fem::Rule;
using mesh::CellType;

constexpr double kRoundoff = 1e-14;
constexpr double kFiniteDifference = 1e-8;  // step 1e-5, central

struct Shape : testing::TestWithParam<CellType> {};
INSTANTIATE_TEST_SUITE_P(Types, Shape, testing::ValuesIn(test::all_cell_types()),
                         [](const auto& info) { return mesh::name(info.param); });

TEST_P(Shape, is_one_at_its_own_node_and_zero_at_others) {
  const Eigen::Matrix3Xd nodes = fem::reference_nodes(GetParam());
  for (int b = 0; b < nodes.cols(); ++b) {
    const auto N = fem::shape_values(GetParam(), nodes.col(b)).N;
    EXPECT_LT((N - Eigen::VectorXd::Unit(nodes.cols(), b)).norm(), kRoundoff) << "node " << b;
  }
}

TEST_P(Shape, derivatives_equal_finite_differences) {
  const Eigen::Vector3d xi(0.21, 0.13, 0.34);
  const auto dN = fem::shape_values(GetParam(), xi).dN;
  const double h = 1e-5;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
    const Eigen::VectorXd difference =
        (fem::shape_values(GetParam(), xi + step).N - fem::shape_values(GetParam(), xi - step).N) / (2 * h);
    EXPECT_LT((dN.col(k) - difference).norm(), kFiniteDifference);
  }
}

TEST_P(Shape, functions_sum_to_one) {
  const auto values = fem::shape_values(GetParam(), {0.21, 0.13, 0.34});
  EXPECT_NEAR(values.N.sum(), 1, kRoundoff);
  EXPECT_LT(values.dN.colwise().sum().norm(), 10 * kRoundoff);
}

double sum(const Rule& rule, int i, int j, int k) {
  double s = 0;
  for (int p = 0; p < rule.w.size(); ++p)
    s += rule.w(p) * std::pow(rule.xi(0, p), i) * std::pow(rule.xi(1, p), j) * std::pow(rule.xi(2, p), k);
  return s;
}

double factorial(int n) { return std::tgamma(n + 1); }
double line_moment(int k) { return k % 2 ? 0 : 2.0 / (k + 1); }
double triangle_moment(int i, int j) { return factorial(i) * factorial(j) / factorial(i + j + 2); }
double tetrahedron_moment(int i, int j, int k) {
  return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
}

TEST(Quadrature, of_tetrahedra_is_exact_to_its_degree) {
  for (const auto& [n, degree] : {std::pair{1, 1}, {4, 2}, {15, 5}})
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j)
        for (int k = 0; i + j + k <= degree; ++k)
          EXPECT_NEAR(sum(fem::tetrahedron_rule(n), i, j, k), tetrahedron_moment(i, j, k), kRoundoff)
              << n << " points, " << i << j << k;
}

TEST(Quadrature, of_wedges_is_exact_to_its_degrees) {
  for (const auto& [n, degree] : {std::pair{1, 1}, {3, 2}, {6, 4}})
    for (int line : {2, 3})
      for (int i = 0; i <= degree; ++i)
        for (int j = 0; i + j <= degree; ++j)
          for (int k = 0; k < 2 * line; ++k)
            EXPECT_NEAR(sum(fem::wedge_rule(n, line), i, j, k), triangle_moment(i, j) * line_moment(k),
                        kRoundoff)
                << n << " x " << line << " points, " << i << j << k;
}

TEST(Quadrature, of_hexahedra_is_exact_to_its_degree) {
  for (int n : {2, 3})
    for (int i = 0; i < 2 * n; ++i)
      for (int j = 0; j < 2 * n; ++j)
        for (int k = 0; k < 2 * n; ++k)
          EXPECT_NEAR(sum(fem::hexahedron_rule(n), i, j, k), line_moment(i) * line_moment(j) * line_moment(k),
                      10 * kRoundoff);
}

TEST(Quadrature, with_an_unknown_number_of_points_is_an_error) {
  EXPECT_THROW(fem::hexahedron_rule(4), Error);
  EXPECT_THROW(fem::tetrahedron_rule(5), Error);
  EXPECT_THROW(fem::wedge_rule(2, 2), Error);
}

}  // namespace
}  // namespace elastogear::shape_test
