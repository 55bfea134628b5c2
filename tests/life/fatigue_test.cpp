#include "elastogear/life/fatigue.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../message_of.h"

namespace elastogear::life::fatigue_test {
namespace {

constexpr double kMPa = 1e6;

SnCurve curve(BelowKnee below) {
  return {.knee_stress = 200 * kMPa, .knee_cycles = 2e6, .slope = 5, .below = below};
}

TEST(SnCurve, is_a_line_in_logarithms_with_a_knee) {
  for (auto below : {BelowKnee::original, BelowKnee::haibach, BelowKnee::elementary}) {
    EXPECT_DOUBLE_EQ(cycles_to_failure(curve(below), 200 * kMPa), 2e6);
    EXPECT_NEAR(cycles_to_failure(curve(below), 400 * kMPa), 2e6 / 32, 1e-6);
  }
  EXPECT_NEAR(cycles_to_failure(curve(BelowKnee::original), 100 * kMPa) / (2e6 * 32), 1, 1e-12);
  EXPECT_NEAR(cycles_to_failure(curve(BelowKnee::haibach), 100 * kMPa) / (2e6 * 512), 1, 1e-12);
  EXPECT_EQ(cycles_to_failure(curve(BelowKnee::elementary), 199 * kMPa), INFINITY);
}

// Tables of the normal distribution.
TEST(NormalQuantile, is_that_of_tables) {
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-15);
  EXPECT_NEAR(normal_quantile(0.9), 1.2815515655446004, 1e-14);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal_quantile(0.01), -2.3263478740408408, 1e-14);
}

TEST(Survival, moves_the_curve_by_its_scatter) {
  SnCurve median = curve(BelowKnee::haibach);
  median.scatter = 1.25;
  const double at_10 = at_survival(median, 0.1).knee_stress, at_90 = at_survival(median, 0.9).knee_stress;
  EXPECT_NEAR(at_10 / at_90, 1.25, 1e-12);
  EXPECT_NEAR(at_10 * at_90, median.knee_stress * median.knee_stress, 1e4);
  EXPECT_NEAR(at_survival(at_survival(median, 0.99), 0.5).knee_stress, median.knee_stress, 1e-6);
}

TEST(Goodman, joins_the_amplitude_to_the_tensile_strength) {
  const MeanStress goodman{MeanStress::Kind::goodman, 1000 * kMPa, 0};
  EXPECT_DOUBLE_EQ(equivalent_amplitude(goodman, 100 * kMPa, 0), 100 * kMPa);
  EXPECT_DOUBLE_EQ(equivalent_amplitude(goodman, 100 * kMPa, 500 * kMPa), 200 * kMPa);
  EXPECT_DOUBLE_EQ(equivalent_amplitude(goodman, 100 * kMPa, -500 * kMPa), 100 * kMPa);
  EXPECT_EQ(equivalent_amplitude(goodman, 100 * kMPa, 1000 * kMPa), INFINITY);
}

// Corners of Haigh's diagram for M = 0.3: ratios -inf, -1, 0 and 0.5.
TEST(Fkm, follows_haighs_diagram_over_its_four_ranges) {
  const double M = 0.3;
  const MeanStress fkm{MeanStress::Kind::fkm, 0, M};
  const auto endured = [&](double mean) { return 1 / equivalent_amplitude(fkm, 1, mean); };
  EXPECT_NEAR(endured(-5), 1 / (1 - M), 1e-14);
  EXPECT_NEAR(endured(-1), 1 / (1 - M), 1e-14);
  EXPECT_NEAR(endured(0), 1, 1e-14);
  EXPECT_NEAR(endured(1), 1 / (1 + M), 1e-14);
  EXPECT_NEAR(endured(3), (3 + M) / (3 * (1 + M) * (1 + M)), 1e-14);
  EXPECT_NEAR(endured(9), endured(3), 1e-14);
  for (double corner : {-1.0, 1.0, 3.0})
    EXPECT_NEAR(endured(corner - 1e-9), endured(corner + 1e-9), 1e-8) << corner;
  // Within a range amplitudes that are endured lie on a line: slope M, then M/3 as M is defined.
  const auto point = [&](double mean) { return Eigen::Vector2d(endured(mean) * mean, endured(mean)); };
  const Eigen::Vector2d between = point(0) - point(0.7), beyond = point(1) - point(2);
  EXPECT_NEAR(between[1] / between[0], -M, 1e-12);
  EXPECT_NEAR(beyond[1] / beyond[0], -M / 3, 1e-12);
}

TEST(Fkm, breaks_where_the_mean_reaches_the_tensile_strength) {
  const MeanStress fkm{MeanStress::Kind::fkm, 800 * kMPa, 0.18};
  EXPECT_TRUE(std::isfinite(equivalent_amplitude(fkm, 100 * kMPa, 799 * kMPa)));
  EXPECT_EQ(equivalent_amplitude(fkm, 100 * kMPa, 800 * kMPa), INFINITY);
}

TEST(Fkm, sensitivity_of_steel_grows_with_its_strength) {
  EXPECT_NEAR(fkm_sensitivity_of_steel(1000 * kMPa), 0.25, 1e-12);
  EXPECT_EQ(fkm_sensitivity_of_steel(200 * kMPa), 0);
}

// A curve found with pulsating stress does the damage of its own cycles.
TEST(FullyReversed, is_the_same_curve_under_the_ratio_that_it_was_found_at) {
  SnCurve pulsating = curve(BelowKnee::elementary);
  pulsating.ratio = 0;
  for (const MeanStress& mean_stress :
       {MeanStress{MeanStress::Kind::none, 0, 0}, MeanStress{MeanStress::Kind::goodman, 1000 * kMPa, 0},
        MeanStress{MeanStress::Kind::fkm, 0, 0.3}}) {
    const SnCurve reversed = fully_reversed(pulsating, mean_stress);
    const std::vector<Cycle> cycles = {{400 * kMPa, 200 * kMPa, 1e5}};
    EXPECT_NEAR(damage(cycles, reversed, mean_stress), 1e5 / 2e6, 1e-12);
  }
}

TEST(Damage, adds_up_over_cycles) {
  const std::vector<Cycle> cycles = {{400 * kMPa, 0, 1000}, {800 * kMPa, 0, 0.5}, {0, 7, 3}};
  EXPECT_NEAR(damage(cycles, curve(BelowKnee::haibach), {}), 1000 / 2e6 + 0.5 * 32 / 2e6, 1e-16);
}

TEST(Check, names_what_is_wrong) {
  const auto message = [](auto change) {
    SnCurve wrong = curve(BelowKnee::haibach);
    change(wrong);
    return test::message_of([&] { check(wrong); });
  };
  EXPECT_EQ(message([](SnCurve&) {}), "no error");
  EXPECT_NE(message([](SnCurve& c) { c.knee_stress = 0; }).find("knee (Pa) = 0 must be > 0"),
            std::string::npos);
  EXPECT_NE(message([](SnCurve& c) { c.slope = 0.5; }).find("slope 0.5"), std::string::npos);
  EXPECT_NE(message([](SnCurve& c) { c.ratio = 1; }).find("stress ratio 1"), std::string::npos);
  EXPECT_NE(message([](SnCurve& c) { c.survival = 1; }).find("survival 1"), std::string::npos);
  EXPECT_NE(message([](SnCurve& c) { c.scatter = 0.8; }).find("scatter 0.8"), std::string::npos);
  EXPECT_NE(test::message_of([] {
              check(MeanStress{MeanStress::Kind::fkm, 0, 1});
            }).find("M = 1"),
            std::string::npos);
  EXPECT_NE(test::message_of([] {
              check(MeanStress{MeanStress::Kind::goodman, 0, 0});
            }).find("strength 0"),
            std::string::npos);
}

}  // namespace
}  // namespace elastogear::life::fatigue_test
