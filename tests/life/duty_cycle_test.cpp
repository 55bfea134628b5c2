#include "elastogear/life/duty_cycle.h"

#include <gtest/gtest.h>

#include "../message_of.h"

namespace elastogear::life::duty_cycle_test {
namespace {

constexpr double kMPa = 1e6;

Revolutions pulse(double height) {
  Revolutions r;
  r.node = {0, 1};
  r.of = {{0}, {1}};
  r.stress.setZero(4, 2);
  r.stress(1, 0) = height;
  r.stress(2, 1) = height / 2;
  return r;
}

const SnCurve kCurve{.knee_stress = 100 * kMPa, .knee_cycles = 1e6, .slope = 3, .below = BelowKnee::original};

TEST(DutyCycle, adds_the_damage_of_its_blocks_by_node) {
  const std::vector<Revolutions> known = {pulse(400 * kMPa), pulse(800 * kMPa)};
  const auto d = duty_cycle_damage(known, {100, 200}, {{100, 1e4, 0}, {200, 1e2, 0}}, 0.5, kCurve, {}, false);
  EXPECT_NEAR(d.of_block(0, 0), 0.5e4 * 8 / 1e6, 1e-12);
  EXPECT_NEAR(d.of_block(0, 1), 0.5e2 * 64 / 1e6, 1e-12);
  EXPECT_NEAR(d.total[0], 0.04 + 0.0032, 1e-12);
  EXPECT_NEAR(d.total[1], d.total[0] / 8, 1e-12);
  EXPECT_NEAR(d.amplitude[0], 400 * kMPa, 1e-3);
}

TEST(DutyCycle, takes_stress_between_known_torques_linearly) {
  const std::vector<Revolutions> known = {pulse(400 * kMPa), pulse(1000 * kMPa)};
  EXPECT_NEAR(history_at(known, between({100, 200}, 150, false), 0).maxCoeff(), 700 * kMPa, 1e-3);
  EXPECT_NEAR(history_at(known, between({100, 200}, 200, false), 0).maxCoeff(), 1000 * kMPa, 1e-3);
  EXPECT_NEAR(history_at(known, between({200, 100}, 100, false), 0).maxCoeff(), 1000 * kMPa, 1e-3);
  EXPECT_NEAR(history_at(known, between({-100, 200}, -100, false), 0).maxCoeff(), 400 * kMPa, 1e-3);
}

TEST(DutyCycle, refuses_torques_outside_those_known_unless_it_may_scale) {
  for (double torque : {50.0, 250.0, -150.0})
    EXPECT_NE(test::message_of([&] {
                between({100, 200}, torque, false);
              }).find("lies outside"),
              std::string::npos)
        << torque;
  EXPECT_NE(test::message_of([&] {
              between({100, 200}, -150, true);
            }).find("lies outside"),
            std::string::npos);
  const std::vector<Revolutions> known = {pulse(400 * kMPa), pulse(1000 * kMPa)};
  EXPECT_NEAR(history_at(known, between({100, 200}, 50, true), 0).maxCoeff(), 200 * kMPa, 1e-3);
  EXPECT_NEAR(history_at(known, between({100, 200}, 400, true), 0).maxCoeff(), 2000 * kMPa, 1e-3);
}

// A history over several revolutions counts as many of them at once.
TEST(DutyCycle, counts_revolutions_of_longer_histories) {
  Revolutions two = pulse(400 * kMPa);
  two.count = 2;
  const auto d = duty_cycle_damage({two}, {100}, {{100, 1e4, 0}}, 1, kCurve, {}, false);
  EXPECT_NEAR(d.total[0], 0.5e4 * 8 / 1e6, 1e-12);
}

}  // namespace
}  // namespace elastogear::life::duty_cycle_test
