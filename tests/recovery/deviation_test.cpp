#include "elastogear/recovery/deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::recovery::deviation_test {
namespace {

constexpr double kRoundoff = 1e-14;

Eigen::VectorXd tensors(std::initializer_list<StressVector> all) {
  Eigen::VectorXd stress(6 * static_cast<Eigen::Index>(all.size()));
  Eigen::Index i = 0;
  for (const StressVector& sigma : all) stress.segment<6>(6 * i++) = sigma;
  return stress;
}

TEST(StressDeviation, of_a_scaled_tensor_is_the_scale_in_every_measure) {
  const Eigen::VectorXd reference = tensors({{100, -20, 30, 10, -5, 40}});
  const StressDeviation d = stress_deviation(1.25 * reference, reference);
  EXPECT_NEAR((d.relative.array() - 0.25).abs().maxCoeff(), 0, kRoundoff);
}

TEST(StressDeviation, of_von_mises_divides_each_component_by_the_local_von_mises_stress) {
  // Uniaxial tension of 200: its von Mises stress is 200.
  const StressDeviation d =
      stress_deviation(tensors({{210, 0, 0, 4, 0, 0}}), tensors({{200, 0, 0, 0, 0, 0}}));
  EXPECT_DOUBLE_EQ(d.of_von_mises[0], 0.05);
  EXPECT_DOUBLE_EQ(d.of_von_mises[3], 0.02);
  EXPECT_DOUBLE_EQ(d.relative[0], 0.05);
  EXPECT_FALSE(std::isfinite(d.relative[3])) << "no share of a component that is zero";
}

TEST(StressDeviation, over_nodes_is_a_ratio_of_root_sums_of_squares) {
  const StressDeviation d = stress_deviation(tensors({{103, 0, 0, 0, 0, 0}, {196, 0, 0, 0, 0, 0}}),
                                             tensors({{100, 0, 0, 0, 0, 0}, {200, 0, 0, 0, 0, 0}}));
  EXPECT_NEAR(d.relative[0], 5 / std::sqrt(50000.0), kRoundoff);
}

TEST(StressDeviation, needs_equal_numbers_of_nodes) {
  EXPECT_THROW(stress_deviation(Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(12)), Error);
}

TEST(SignalDeviation, of_a_sine_from_its_scaled_and_shifted_self_is_that_of_the_integrals) {
  const Eigen::Index n = 2001;
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(n, 0, 2 * std::numbers::pi);
  const Eigen::VectorXd sine = time.array().sin(), cosine = time.array().cos();
  const SignalDeviation d = signal_deviation(time, 1.5 * sine + 0.5 * cosine, sine);
  const double discretisation = std::pow(time[1], 2);  // of the trapezoidal rule
  EXPECT_NEAR(d.l2, std::sqrt(0.5), discretisation);
  EXPECT_NEAR(d.peak.value, std::sqrt(2.5), discretisation);
  EXPECT_NEAR(d.reference_peak.value, 1, discretisation);
  EXPECT_NEAR(d.reference_peak.time, std::numbers::pi / 2, time[1]);
  EXPECT_NEAR(d.peak.time, std::atan2(1.5, 0.5), time[1]);
}

TEST(SignalDeviation, weighs_values_by_the_time_they_last) {
  const Eigen::Vector3d time(0, 1, 10), reference = Eigen::Vector3d::Ones();
  // difference 1 at time 0 only: the integral of its square is 1/2, that of the reference's 10
  EXPECT_DOUBLE_EQ(signal_deviation(time, Eigen::Vector3d(2, 1, 1), reference).l2, std::sqrt(0.05));
}

TEST(AtTimes, is_linear_between_and_refuses_times_outside) {
  const Eigen::Vector3d time(1, 2, 4);
  const Eigen::RowVector3d values(10, 20, 0);
  const Eigen::MatrixXd found = at_times(time, values, Eigen::Vector4d(1, 1.5, 3, 4));
  EXPECT_EQ(found, Eigen::RowVector4d(10, 15, 10, 0));
  EXPECT_THROW(at_times(time, values, Eigen::VectorXd::Constant(1, 4.1)), Error);
  EXPECT_THROW(at_times(time, values, Eigen::VectorXd::Constant(1, 0.9)), Error);
}

TEST(MatchNumbers, finds_nodes_in_any_order_and_names_the_one_that_is_missing) {
  EXPECT_EQ(match_numbers({7, 3, 9}, {9, 7}), (std::vector<int>{2, 0}));
  try {
    match_numbers({7, 3}, {3, 8});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("node 8"), std::string::npos);
  }
}

TEST(MatchPositions, finds_the_nearest_within_the_tolerance) {
  Eigen::Matrix3Xd X(3, 3), reference(3, 2);
  X << 0, 1, 2, 0, 0, 0, 0, 0, 0;
  reference << 2.001, 0.999, 0, 0, 0, 0;
  EXPECT_EQ(match_positions(X, reference, 2e-3), (std::vector<int>{2, 1}));
  EXPECT_THROW(match_positions(X, reference, 1e-4), Error);
  EXPECT_THROW(match_positions(Eigen::Matrix3Xd(3, 0), reference, 1), Error);
}

}  // namespace
}  // namespace elastogear::recovery::deviation_test
