// Loads and prescribed motions over time.
#include "elastogear/dynamics/axis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastogear/base/error.h"

namespace elastogear::axis_test {
using namespace dynamics;

namespace {

constexpr double kRoundoff = 1e-13, kStep = 1e-5, kDifference = 1e-8, kTwiceDifferenced = 1e-5;

Drive sine_table() {
  std::vector<double> time, value;
  for (int i = 0; i <= 64; ++i) {
    time.push_back(M_PI * i / 64);
    value.push_back(std::sin(time.back()));
  }
  return table_drive(time, value);
}

TEST(Signal, is_linear_between_its_times_and_constant_beyond) {
  const Signal s = table_signal({1, 2, 4}, {10, 20, 0});
  EXPECT_EQ(at(s, 0), 10);
  EXPECT_DOUBLE_EQ(at(s, 1.5), 15);
  EXPECT_DOUBLE_EQ(at(s, 3), 10);
  EXPECT_EQ(at(s, 9), 0);
  EXPECT_EQ(at(Signal{}, 1), 0);
  EXPECT_EQ(at(constant_signal(7), 3), 7);
  EXPECT_DOUBLE_EQ(at(ramp_signal(6, 3), 1), 2);
  EXPECT_EQ(at(ramp_signal(6, 3), 5), 6);
}

TEST(Drive, rates_are_the_derivatives_of_the_coordinate) {
  for (const Drive& drive : {speed_drive(1, -2), spin_up_drive(1, 3, 2), sine_table()})
    for (double t : {0.3, 1.1, 1.99, 2.5}) {
      const double next = at(drive, t + kStep).s, now = at(drive, t).s, before = at(drive, t - kStep).s;
      EXPECT_NEAR(at(drive, t).s_dot, (next - before) / (2 * kStep), kDifference);
      EXPECT_NEAR(at(drive, t).s_ddot, (next - 2 * now + before) / (kStep * kStep), kTwiceDifferenced);
    }
}

TEST(Drive, spins_up_from_rest_to_its_speed_without_a_jump) {
  const Drive drive = spin_up_drive(5, 3, 2);
  EXPECT_EQ(at(drive, 0).s, 5);
  EXPECT_EQ(at(drive, 0).s_dot, 0);
  EXPECT_EQ(at(drive, 0).s_ddot, 0);
  const Prescribed before = at(drive, 2 - 1e-9), after = at(drive, 2 + 1e-9);
  EXPECT_NEAR(before.s, after.s, 1e-8);
  EXPECT_NEAR(before.s_dot, after.s_dot, 1e-8);
  EXPECT_NEAR(before.s_ddot, after.s_ddot, 1e-8);
  EXPECT_EQ(after.s_dot, 3);
}

TEST(Drive, of_a_table_is_the_spline_through_its_values) {
  const Drive drive = sine_table();
  for (std::size_t i = 0; i < drive.time.size(); ++i)
    EXPECT_NEAR(at(drive, drive.time[i]).s, drive.value[i], kRoundoff);
  EXPECT_NEAR(at(drive, 1).s, std::sin(1), 1e-7);  // (h^4, h: pi/64)
  EXPECT_NEAR(at(drive, 1).s_ddot, -std::sin(1), 1e-3);
}

TEST(Resistance, has_its_derivative) {
  const Axis axis{.damping = 0.7, .friction = 3, .friction_rate = 0.1};
  for (double rate : {-0.2, 0.0, 0.05, 1.0})
    EXPECT_NEAR(resistance_rate(axis, rate),
                (resistance(axis, rate + kStep) - resistance(axis, rate - kStep)) / (2 * kStep), 1e-6);
  EXPECT_NEAR(resistance(axis, 5), 3.5 + 3, kRoundoff * 10);
}

TEST(Axis, refuses_what_makes_no_sense) {
  EXPECT_THROW(table_signal({0, 1, 1}, {0, 1, 2}), Error);
  EXPECT_THROW(table_signal({0}, {0}), Error);
  EXPECT_THROW(table_drive({0, 1}, {0, NAN}), Error);
  EXPECT_THROW(ramp_signal(1, 0), Error);
  EXPECT_THROW(spin_up_drive(0, 1, -1), Error);
  EXPECT_THROW(validate({.damping = -1}, ""), Error);
  EXPECT_THROW(validate({.friction = 1}, ""), Error);  // no rate
  EXPECT_THROW(validate({.load = constant_signal(1), .drive = speed_drive(0, 1)}, ""), Error);
  EXPECT_THROW(validate({.load = constant_signal(INFINITY)}, ""), Error);
  const auto law = [](double t, double, double) { return 1 / t; };
  EXPECT_THROW(validate({.drive = speed_drive(0, 1), .law = law}, ""), Error);
  EXPECT_THROW(law_force({.law = law}, 0, 0, 0), Error);
  EXPECT_EQ(law_force({.law = law}, 2, 0, 0), 0.5);
  EXPECT_THROW(require_covers({.load = table_signal({0, 1}, {0, 1})}, 1.1, ""), Error);
  EXPECT_THROW(require_covers({.drive = table_drive({0.1, 2}, {0, 1})}, 1, ""), Error);
  EXPECT_NO_THROW(require_covers({.load = ramp_signal(1, 0.1)}, 1, ""));
}

}  // namespace
}  // namespace elastogear::axis_test
