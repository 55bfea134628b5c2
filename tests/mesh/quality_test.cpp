#include "elastogear/mesh/quality.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::mesh::quality_test {
namespace {

constexpr double kRoundoff = 1e-13;

Mesh cube() {
  Mesh mesh;
  mesh.X.resize(3, 8);
  mesh.X << 0, 1, 1, 0, 0, 1, 1, 0,  //
      0, 0, 1, 1, 0, 0, 1, 1,        //
      0, 0, 0, 0, 1, 1, 1, 1;
  const int nodes[] = {0, 1, 2, 3, 4, 5, 6, 7};
  mesh.cells.add(CellType::hex8, nodes);
  return mesh;
}

TEST(ScaledJacobian, is_1_for_a_turned_brick_of_any_sides) {
  Mesh mesh = cube();
  const Eigen::Matrix3d R = rotation_matrix({0.3, -0.7, 1.1});
  mesh.X = R * Eigen::Vector3d(1e-3, 2e-2, 7).asDiagonal() * mesh.X;
  EXPECT_NEAR(scaled_jacobian(mesh, 0), 1, kRoundoff);
}

TEST(ScaledJacobian, of_a_sheared_brick_is_the_sine_of_its_angle) {
  Mesh mesh = cube();
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 2) = 1;  // 45 degrees
  mesh.X = shear * mesh.X;
  EXPECT_NEAR(scaled_jacobian(mesh, 0), std::sqrt(0.5), kRoundoff);
}

TEST(ScaledJacobian, is_negative_when_a_corner_is_folded_and_0_without_volume) {
  Mesh folded = cube();
  folded.X.col(6) << 0.2, 0.2, 0.2;
  EXPECT_LT(scaled_jacobian(folded, 0), 0);
  Mesh collapsed = cube();
  collapsed.X.row(2).setZero();
  EXPECT_EQ(scaled_jacobian(collapsed, 0), 0);
}

TEST(Volume, is_exact_for_a_frustum) {
  Mesh mesh = cube();
  for (int a = 4; a < 8; ++a) mesh.X.col(a).head<2>() *= 0.5;
  EXPECT_NEAR(volume(mesh, 0), (1 + 0.5 + 0.25) / 3, kRoundoff);
}

TEST(SmallestJacobian, of_a_brick_is_an_eighth_of_its_volume) {
  Mesh mesh = cube();
  mesh.X *= 2;
  EXPECT_NEAR(smallest_jacobian(mesh, 0), 1, kRoundoff);
}

TEST(Quality, finds_the_worst_and_the_first_inverted_cell) {
  Mesh mesh = cube();
  mesh.X.conservativeResize(3, 16);
  mesh.X.rightCols(8) = mesh.X.leftCols(8);
  mesh.X.row(2).tail(4).setConstant(-1);  // inside out
  const int nodes[] = {8, 9, 10, 11, 12, 13, 14, 15};
  mesh.cells.add(CellType::hex8, nodes);
  const Quality q = quality(mesh);
  EXPECT_EQ(q.worst_cell, 1);
  EXPECT_NEAR(q.min_scaled_jacobian, -1, kRoundoff);
  EXPECT_NEAR(q.mean_scaled_jacobian, 0, kRoundoff);
  EXPECT_NEAR(q.min_jacobian, -0.125, kRoundoff);
  EXPECT_EQ(first_inverted_cell(mesh), 1);
  EXPECT_EQ(first_inverted_cell(cube()), std::nullopt);
}

// The regular cell of each kind, and what its second-order kind adds.
struct Regular {
  CellType type, second_order;
  std::vector<Eigen::Vector3d> corners;
};
const double kHalf = 0.5, kHeight = std::sqrt(0.75);
const Regular kRegular[] = {
    {CellType::tet4, CellType::tet10, {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}},
    {CellType::wedge6,
     CellType::wedge15,
     {{0, 0, 0}, {1, 0, 0}, {kHalf, kHeight, 0}, {0, 0, 3}, {1, 0, 3}, {kHalf, kHeight, 3}}},
    {CellType::hex8,
     CellType::hex20,
     {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 3}, {1, 0, 3}, {1, 2, 3}, {0, 2, 3}}},
    {CellType::pyramid5,
     CellType::pyramid5,
     {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, std::sqrt(2.0)}}}};

Mesh single_cell(CellType type, std::vector<Eigen::Vector3d> X) {
  for (const auto& [a, b] : edges(type))
    if (static_cast<int>(X.size()) < node_count(type)) X.push_back((X[a] + X[b]) / 2);
  Mesh mesh;
  mesh.X.resize(3, static_cast<Eigen::Index>(X.size()));
  std::vector<int> nodes;
  for (std::size_t i = 0; i < X.size(); ++i) {
    mesh.X.col(static_cast<Eigen::Index>(i)) = X[i];
    nodes.push_back(static_cast<int>(i));
  }
  mesh.cells.add(type, nodes);
  return mesh;
}

TEST(ScaledJacobian, is_1_for_regular_cells_of_every_type_and_minus_1_for_their_mirror_images) {
  for (const Regular& regular : kRegular)
    for (CellType type : {regular.type, regular.second_order}) {
      Mesh mesh = single_cell(type, regular.corners);
      EXPECT_NEAR(scaled_jacobian(mesh, 0), 1, kRoundoff) << name(type);
      EXPECT_EQ(first_inverted_cell(mesh), std::nullopt) << name(type);
      EXPECT_GT(quality(mesh).min_jacobian, 0) << name(type);
      mesh.X.row(0) *= -1;
      EXPECT_NEAR(scaled_jacobian(mesh, 0), -1, kRoundoff) << name(type);
      EXPECT_EQ(first_inverted_cell(mesh), 0) << name(type);
    }
}

TEST(ScaledJacobian, is_lower_for_any_other_shape) {
  for (const Regular& regular : kRegular) {
    auto corners = regular.corners;
    corners[0] += Eigen::Vector3d(0.1, -0.2, 0.15);
    const double sj = scaled_jacobian(single_cell(regular.type, corners), 0);
    EXPECT_LT(sj, 0.99) << name(regular.type);
    EXPECT_GT(sj, 0.5) << name(regular.type);
  }
}

TEST(ScaledJacobian, of_a_second_order_cell_vanishes_with_a_midside_node_at_a_quarter) {
  for (const Regular& regular : kRegular) {
    if (regular.type == regular.second_order) continue;
    Mesh mesh = single_cell(regular.second_order, regular.corners);
    const auto [a, b] = edges(regular.second_order)[0];
    auto midside = mesh.X.col(corner_count(regular.second_order));
    midside = 0.75 * mesh.X.col(a) + 0.25 * mesh.X.col(b);
    EXPECT_NEAR(smallest_jacobian(mesh, 0), 0, kRoundoff) << name(regular.second_order);
    midside = 0.8 * mesh.X.col(a) + 0.2 * mesh.X.col(b);
    EXPECT_LT(scaled_jacobian(mesh, 0), 0) << name(regular.second_order);
    EXPECT_EQ(first_inverted_cell(mesh), 0) << name(regular.second_order);
  }
}

TEST(Volume, is_refused_for_cells_without_the_rule) {
  EXPECT_THROW(volume(single_cell(CellType::tet4, kRegular[0].corners), 0), Error);
}

TEST(Quality, refuses_a_mesh_without_cells) { EXPECT_THROW(quality(Mesh{}), Error); }

TEST(FirstInvertedCell, counts_a_cell_without_finite_jacobian_as_inverted) {
  Mesh mesh = cube();
  mesh.X(1, 3) = std::nan("");
  EXPECT_EQ(first_inverted_cell(mesh), 0);
}

}  // namespace
}  // namespace elastogear::mesh::quality_test
