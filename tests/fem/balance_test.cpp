#include "elastogear/fem/balance.h"

#include <gtest/gtest.h>

#include "brick.h"
#include "elastogear/fem/material.h"

namespace elastogear::balance_test {
namespace {

constexpr double kRoundoff = 1e-13;

// A field of constant strain is in balance at inner nodes on any mesh.
TEST(Imbalance, of_constant_strain_is_roundoff_and_of_one_moved_node_is_not) {
  const auto mesh = test::distorted(test::brick({3, 3, 3}, {1, 1, 1}), 0.05);
  const auto region = fem::cell_regions(mesh, test::kSteelBody);
  std::vector<bool> inner(static_cast<std::size_t>(mesh.n_nodes()), true);
  for (const mesh::Face& face : mesh.face_sets.at("surface"))
    for (int node : face) inner[node] = false;
  const Eigen::Matrix3d gradient = 1e-3 * Eigen::Matrix3d::Random();
  Eigen::MatrixXd u(3 * mesh.n_nodes(), 2);
  u.col(0) = (gradient * mesh.X).reshaped();
  u.col(1) = u.col(0);
  const auto node = std::find(inner.begin(), inner.end(), true) - inner.begin();
  u(3 * node, 1) += 1e-3 * u.col(0).lpNorm<Eigen::Infinity>();
  const Eigen::VectorXd left =
      fem::residual({mesh, test::kSteelBody, region, inner, {}}, u, Eigen::Vector2d::Zero());
  EXPECT_LT(left(0), kRoundoff);
  EXPECT_GT(left(1), 1e-5);
}

}  // namespace
}  // namespace elastogear::balance_test
