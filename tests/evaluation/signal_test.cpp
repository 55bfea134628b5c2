#include "evaluation/signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../message_of.h"

namespace elastogear::evaluation::signal_test {
namespace {

using std::numbers::pi;

// 3 + 2 cos(2 pi u + 0.4) + 0.5 cos(6 pi u - 1)
Eigen::VectorXd harmonics(const Eigen::VectorXd& u) {
  return u.unaryExpr(
      [](double x) { return 3 + 2 * std::cos(2 * pi * x + 0.4) + 0.5 * std::cos(6 * pi * x - 1); });
}

Eigen::VectorXd even(int n, double begin, double pitches) {
  return Eigen::VectorXd::LinSpaced(n, begin, begin + pitches * (n - 1) / n);
}

TEST(EvenPositions, fill_whole_pitches_with_the_last_ones_end_excluded) {
  EXPECT_EQ(even_positions(even(16, 0.3, 1))->pitches, 1);
  EXPECT_EQ(even_positions(even(48, 0, 3))->pitches, 3);
  EXPECT_EQ(even_positions(even(48, 0, 3))->n, 48);
  EXPECT_FALSE(even_positions(even(16, 0, 0.85)));
  EXPECT_FALSE(even_positions(Eigen::VectorXd::LinSpaced(16, 0, 1)));
  EXPECT_FALSE(even_positions(Eigen::Vector3d(0, 0.2, 0.55)));
  EXPECT_FALSE(even_positions(Eigen::VectorXd::Constant(1, 0.2)));
}

TEST(EvenPositions, may_miss_a_tenth) {
  const Eigen::VectorXd u = even(32, 0, 1);
  std::vector<int> found;
  for (int i = 0; i < 31; ++i)
    if (i != 10) found.push_back(i);
  EXPECT_EQ(even_positions(u(found))->n, 32);
  EXPECT_FALSE(even_positions(u.head(28)));
  const Spectrum s = fourier_orders(u(found), harmonics(u)(found));
  EXPECT_NEAR(amplitude_at(s, 1), 2, 0.02 * 2);
  EXPECT_NEAR(amplitude_at(s, 3), 0.5, 0.02 * 2);
}

TEST(DynamicFactor, is_the_largest_over_the_mean_force) {
  EXPECT_DOUBLE_EQ(dynamic_factor(Eigen::Vector4d(1, 2, 4, 1)), 2);
  EXPECT_TRUE(std::isnan(dynamic_factor(Eigen::Vector2d::Zero())));
}

TEST(FourierOrders, of_harmonics_are_their_amplitudes_and_phases_from_any_roll_angle_on) {
  for (const Eigen::VectorXd& u : {even(16, 0, 1), even(15, 0.3, 1), even(64, -0.7, 2)}) {
    const Spectrum s = fourier_orders(u, harmonics(u));
    for (Eigen::Index i = 0; i < s.order.size(); ++i) {
      const double order = s.order[i];
      const double expected = std::abs(order - 1) < 1e-9 ? 2 : std::abs(order - 3) < 1e-9 ? 0.5 : 0;
      EXPECT_NEAR(s.amplitude[i], expected, 1e-12) << "order " << order;
      if (expected > 0) {
        EXPECT_NEAR(s.phase[i], expected == 2 ? 0.4 : -1, 1e-10);
      }
    }
    EXPECT_NEAR(amplitude_at(s, 3), 0.5, 1e-12);
    EXPECT_EQ(amplitude_at(s, 1000), 0);
  }
}

TEST(FourierOrders, count_the_highest_one_of_an_even_number_of_samples_once) {
  const Eigen::VectorXd u = even(8, 0, 1);
  const Spectrum s = fourier_orders(u, u.unaryExpr([](double x) { return std::cos(8 * pi * x); }));
  EXPECT_NEAR(s.amplitude[3], 1, 1e-12);
}

TEST(FourierOrders, are_refused_for_parts_of_pitches) {
  const Eigen::VectorXd u = even(16, 0, 0.9);
  EXPECT_NE(test::message_of([&] { fourier_orders(u, u); }).find("whole pitches"), std::string::npos);
}

TEST(WindowedOrders, show_the_amplitudes_of_a_run_whose_speed_changes) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(4001, 0, 1);
  const Eigen::VectorXd u = t.unaryExpr([](double x) { return 20 * x + 2 * x * x; });
  const Spectrum s = windowed_orders(u, harmonics(u));
  EXPECT_NEAR(amplitude_at(s, 1), 2, 0.01 * 2);
  EXPECT_NEAR(amplitude_at(s, 3), 0.5, 0.01 * 0.5);
  EXPECT_LT(amplitude_at(s, 2), 0.002);
}

TEST(WindowedOrders, are_refused_where_the_gears_do_not_roll_on) {
  EXPECT_NE(test::message_of([&] {
              windowed_orders(Eigen::Vector3d(0, 2, 1), Eigen::Vector3d::Ones());
            }).find("must increase"),
            std::string::npos);
  EXPECT_NE(test::message_of([&] {
              windowed_orders(Eigen::Vector3d(0, 0.5, 1), Eigen::Vector3d::Ones());
            }).find("at least 2"),
            std::string::npos);
}

}  // namespace
}  // namespace elastogear::evaluation::signal_test
