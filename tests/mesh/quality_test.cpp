#include "elastogear/mesh/quality.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::mesh {
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

TEST(GaussJacobian, of_a_brick_is_an_eighth_of_its_volume) {
  Mesh mesh = cube();
  mesh.X *= 2;
  EXPECT_NEAR(gauss_jacobian(mesh, 0), 1, kRoundoff);
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
  EXPECT_NEAR(q.min_gauss_jacobian, -0.125, kRoundoff);
  EXPECT_EQ(first_inverted_cell(mesh), 1);
  EXPECT_EQ(first_inverted_cell(cube()), std::nullopt);
}

TEST(Quality, refuses_a_mesh_without_cells) { EXPECT_THROW(quality(Mesh{}), Error); }

TEST(FirstInvertedCell, counts_a_cell_without_finite_jacobian_as_inverted) {
  Mesh mesh = cube();
  mesh.X(1, 3) = std::nan("");
  EXPECT_EQ(first_inverted_cell(mesh), 0);
}

}  // namespace
}  // namespace elastogear::mesh
