#include "elastogear/recovery/stress.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastogear/base/rotation.h"

namespace elastogear::recovery::stress_test {
namespace {

constexpr double kRoundoff = 1e-14;

StressVector tensor_to_vector(const Eigen::Matrix3d& T) {
  StressVector s;
  s << T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2);
  return s;
}

TEST(VonMises, of_uniaxial_tension_is_the_tension_and_of_pure_shear_sqrt3_times_the_shear) {
  EXPECT_DOUBLE_EQ(von_mises(StressVector{100, 0, 0, 0, 0, 0}), 100);
  EXPECT_DOUBLE_EQ(von_mises(StressVector{0, 0, 0, 0, 50, 0}), 50 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(von_mises(StressVector{-7, -7, -7, 0, 0, 0}), 0);
}

TEST(EquivalentStresses, do_not_change_under_rotation) {
  Eigen::Matrix3d T;
  T << 3, 1, -2, 1, -4, 0.5, -2, 0.5, 7;
  const Eigen::Matrix3d R = rotation_matrix({0.3, -1.1, 0.7});
  const StressVector a = tensor_to_vector(T), b = tensor_to_vector(R * T * R.transpose());
  EXPECT_NEAR(von_mises(a), von_mises(b), 20 * kRoundoff * von_mises(a));
  EXPECT_NEAR(rankine(a), rankine(b), 20 * kRoundoff * von_mises(a));
}

TEST(Rankine, is_the_largest_principal_stress_with_its_sign) {
  const Eigen::Matrix3d R = rotation_matrix({0.3, -1.1, 0.7});
  const Eigen::Matrix3d T = R * Eigen::Vector3d(-5, -2, -9).asDiagonal() * R.transpose();
  EXPECT_NEAR(rankine(tensor_to_vector(T)), -2, 50 * kRoundoff);
}

// Principal values from far apart to equal, either pair of them, at any size: one by one and together, more
// than are taken at a time.
TEST(Rankine, is_exact_to_roundoff_where_principal_stresses_coincide) {
  constexpr int kTensors = 1003;
  Eigen::MatrixXd stress(6 * kTensors, 1);
  Eigen::VectorXd expected(kTensors), size(kTensors);
  for (int i = 0; i < kTensors; ++i) {
    const double gap = std::pow(10., -(i % 18)), scale = std::pow(10., i % 13 - 3);
    const Eigen::Vector3d principal = i % 3 == 0   ? Eigen::Vector3d(1, 1 - gap, -1)
                                      : i % 3 == 1 ? Eigen::Vector3d(gap - 1, -1, -1)
                                                   : Eigen::Vector3d(3, 3, 3 - gap);
    const Eigen::Matrix3d R = rotation_matrix({0.1 * i, std::sin(i), -1});
    stress.col(0).segment<6>(6 * i) = scale * tensor_to_vector(R * principal.asDiagonal() * R.transpose());
    expected[i] = scale * principal.maxCoeff();
    size[i] = scale * principal.norm();
  }
  const Eigen::VectorXd together = rankine(stress);
  for (int i = 0; i < kTensors; ++i) {
    EXPECT_NEAR(together[i], expected[i], kRoundoff * size[i]);
    EXPECT_NEAR(rankine(StressVector(stress.col(0).segment<6>(6 * i))), expected[i], kRoundoff * size[i]);
  }
}

TEST(Rankine, of_equal_pressure_is_minus_the_pressure) {
  EXPECT_EQ(rankine(StressVector{-7, -7, -7, 0, 0, 0}), -7);
  EXPECT_EQ(rankine(StressVector{0, 0, 0, 0, 0, 0}), 0);
}

TEST(StressHistory, is_Psi_times_q_for_dense_and_sparse_rows) {
  model::Stress stress;
  stress.node = {4, 8, 15};
  const model::DenseRows Psi = model::DenseRows::Random(18, 5);
  stress.Psi = Psi;
  const Eigen::MatrixXd q = Eigen::MatrixXd::Random(5, 7);
  const StressHistory dense = stress_history(stress, {2, 0}, q);
  EXPECT_EQ(dense.node, (std::vector<int>{15, 4}));
  EXPECT_NEAR((dense.stress.topRows(6) - Psi.bottomRows(6) * q).norm(), 0, 10 * kRoundoff);
  EXPECT_DOUBLE_EQ(dense.von_mises(1, 3), von_mises(StressVector(dense.stress.col(3).tail<6>())));
  stress.Psi = model::SparseRows(Psi.sparseView());
  EXPECT_NEAR((stress_history(stress, {2, 0}, q).stress - dense.stress).norm(), 0, 10 * kRoundoff);
}

}  // namespace
}  // namespace elastogear::recovery::stress_test
