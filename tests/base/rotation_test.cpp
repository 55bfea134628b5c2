#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "elastogear/base/rotation.h"

namespace elastogear::rotation_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRoundoff = 1e-14;
constexpr double kDifferenceStep = 1e-6;
constexpr double kDifferenceError = 1e-10;  // central difference: step^2 and roundoff / step

const Vector3d a(0.3, -1.2, 0.7), b(-0.4, 0.9, 2.0);

TEST(Skew, is_the_cross_product) { EXPECT_LE((skew(a) * b - a.cross(b)).norm(), kRoundoff); }

TEST(Skew, is_antisymmetric) { EXPECT_EQ((skew(a) + skew(a).transpose()).norm(), 0.0); }

TEST(RotationMatrix, of_zero_is_the_identity) {
  EXPECT_EQ(rotation_matrix(Vector3d::Zero()), Matrix3d::Identity());
}

TEST(RotationMatrix, is_orthogonal_and_keeps_handedness) {
  const Matrix3d R = rotation_matrix(a);
  EXPECT_LE((R.transpose() * R - Matrix3d::Identity()).norm(), kRoundoff);
  EXPECT_NEAR(R.determinant(), 1.0, kRoundoff);
}

TEST(RotationMatrix, keeps_its_axis) { EXPECT_LE((rotation_matrix(a) * a - a).norm(), kRoundoff); }

TEST(RotationMatrix, of_the_opposite_vector_is_the_inverse) {
  EXPECT_LE((rotation_matrix(a) * rotation_matrix(-a) - Matrix3d::Identity()).norm(), kRoundoff);
}

TEST(RotationMatrix, adds_angles_about_one_axis) {
  EXPECT_LE((rotation_matrix(0.4 * a) * rotation_matrix(0.6 * a) - rotation_matrix(a)).norm(), kRoundoff);
}

TEST(RotationMatrix, turns_x_to_y_by_a_quarter_about_z) {
  const Vector3d turned = rotation_matrix({0, 0, std::numbers::pi / 2}) * Vector3d::UnitX();
  EXPECT_LE((turned - Vector3d::UnitY()).norm(), kRoundoff);
}

TEST(RotationMatrix, has_the_skew_matrix_as_derivative_at_zero) {
  const Vector3d step = kDifferenceStep * a;
  const Matrix3d derivative = (rotation_matrix(step) - rotation_matrix(-step)) / (2 * kDifferenceStep);
  EXPECT_LE((derivative - skew(a)).norm(), kDifferenceError);
}

TEST(RotationMatrix, of_a_tiny_vector_is_first_order) {
  const Vector3d tiny = 1e-170 * a;  // its square is below the smallest double
  EXPECT_LE((rotation_matrix(tiny) - Matrix3d::Identity()).norm(), kRoundoff);
}

}  // namespace
}  // namespace elastogear::rotation_test
