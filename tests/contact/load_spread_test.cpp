// How the force on a node of the contact surface is spread over the nodes around it.

#include "elastogear/contact/load_spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace elastogear::contact::load_spread_test {
namespace {

constexpr double kRoundoff = 1e-12;

// Nodes (i, j), 0 <= i, j < 3, number 3 j + i, of four faces on a cylinder of radius 5 m.
struct Grid {
  Eigen::Matrix3Xd X{3, 9};
  std::vector<std::vector<int>> face;
  std::vector<char> may_bear = std::vector<char>(9, 1);

  Grid() {
    for (int n = 0; n < 9; ++n) {
      const double angle = (n % 3 - 1) / 5.0;
      const int row = n / 3;
      X.col(n) << 5 * std::sin(angle), row, 5 * std::cos(angle);
    }
    for (int n : {0, 1, 3, 4}) face.push_back({n, n + 1, n + 3, n + 4});
  }
};

TEST(Spread, is_even_in_the_middle_of_equal_faces) {
  const Grid grid;
  const Spread of = spread(grid.X, grid.face, 4, grid.may_bear);
  ASSERT_EQ(of.node.size(), 9U);
  for (double weight : of.weight) EXPECT_NEAR(weight, 1. / 9, kRoundoff);
}

TEST(Spread, keeps_force_and_place_where_nodes_lie_to_one_side) {
  Grid grid;
  grid.X.row(2).setZero();
  grid.X.col(8) += Eigen::Vector3d(0.3, 0.2, 0);
  grid.may_bear[6] = 0;
  for (int node : {0, 1, 4}) {
    std::vector<std::vector<int>> at_node;
    for (const auto& face : grid.face)
      if (std::find(face.begin(), face.end(), node) != face.end()) at_node.push_back(face);
    const Spread of = spread(grid.X, at_node, node, grid.may_bear);
    EXPECT_EQ(std::count(of.node.begin(), of.node.end(), 6), 0);
    EXPECT_NEAR(of.weight.sum(), 1, kRoundoff);
    EXPECT_LT((grid.X(Eigen::all, of.node) * of.weight - grid.X.col(node)).norm(), kRoundoff);
  }
}

}  // namespace
}  // namespace elastogear::contact::load_spread_test
