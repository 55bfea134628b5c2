// Modifications and deviations of flanks.
#include "elastogear/gear/modification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "elastogear/base/error.h"
#include "elastogear/gear/design.h"

namespace elastogear::gear::modification_test {
namespace {

using Eigen::Vector3d;

constexpr double kWidth = 16e-3;  // m
constexpr double kRoundoff = 1e-15;

// A point of the exact flank at a length of roll from the start of contact, and its outward normal.
struct Point {
  Vector3d x, n;
};

Point point(const Toothing& t, const Flank& flank, double roll, double z) {
  const double r = std::hypot(t.r_b, length_of_roll(t, t.r_start) + roll);
  const double theta = tooth_angle(t, flank.tooth) + z / t.p + flank.side * psi(t, r);
  const Vector3d x(r * std::cos(theta), r * std::sin(theta), z);
  return {x, flank_normal(t, flank, x)};
}

class Modification : public ::testing::Test {
 protected:
  const Toothing t = derive(Design{}).wheel;
  const Flank left{3, 1}, right{3, -1};
  const double profile = profile_length(t);
  FlankDeviations d;

  Modification() { d.width = kWidth; }
  double at(double share, double z, const Flank& flank) const {
    return flank_deviation(t, d, flank, point(t, flank, share * profile, z).x);
  }
  double at(double share, double z = 0) const { return at(share, z, left); }
};

TEST_F(Modification, reliefs_begin_at_their_length_and_end_with_their_amount) {
  d.left.tip = {20e-6, 0.4 * profile, false};
  d.left.root = {10e-6, 0.2 * profile, true};
  d.left.end = {8e-6, 2e-3, false};
  EXPECT_NEAR(at(1), -20e-6, kRoundoff);
  EXPECT_NEAR(at(0.8), -10e-6, kRoundoff);
  EXPECT_NEAR(at(0), -10e-6, kRoundoff);
  EXPECT_NEAR(at(0.1), -2.5e-6, kRoundoff);
  EXPECT_EQ(at(0.5), 0);
  EXPECT_NEAR(at(0.5, 7e-3), -4e-6, kRoundoff);
  EXPECT_NEAR(at(0.5, -8e-3), -8e-6, kRoundoff);
  EXPECT_EQ(at(0.9, 8e-3, right), 0);
}

// At a corner of a flank its normal would jump, and with it the force of a line of contact that stands there.
TEST_F(Modification, linear_reliefs_begin_without_a_corner) {
  d.left.tip = {20e-6, 0.4 * profile, false};
  const double h = 1e-6, bend = 20e-6 / (0.4 * 0.4) / (2 * 0.05);
  for (double s = 0.57; s < 0.63; s += 0.001) {
    const double slope = (at(s + h) - at(s - h)) / (2 * h),
                 next = (at(s + 0.001 + h) - at(s + 0.001 - h)) / (2 * h);
    EXPECT_LT(std::abs(next - slope), 1.01 * 0.001 * bend) << s;
  }
  EXPECT_NEAR(at(0.6), -20e-6 * 0.05 / 4, kRoundoff);
  EXPECT_EQ(at(0.579), 0);
}

TEST_F(Modification, crownings_slopes_and_twist_have_their_amounts_at_the_ends) {
  d.left.C_alpha = 3e-6;
  EXPECT_NEAR(at(0), -3e-6, kRoundoff);
  EXPECT_NEAR(at(0.75), -0.75e-6, kRoundoff);
  d.left = {};
  d.left.C_Halpha = 3e-6;
  EXPECT_NEAR(at(0.25), -0.75e-6, kRoundoff);
  d.left = {};
  d.left.C_beta = 4e-6;
  d.left.C_Hbeta = 6e-6;
  EXPECT_NEAR(at(0.3, kWidth / 2), -10e-6, kRoundoff);
  EXPECT_NEAR(at(0.3, -kWidth / 2), -4e-6, kRoundoff);
  d.left = {};
  d.left.S_alpha = 8e-6;
  const auto slope = [&](double z) { return at(0, z) - at(1, z); };
  EXPECT_NEAR(slope(kWidth / 2) - slope(-kWidth / 2), 8e-6, kRoundoff);
  EXPECT_NEAR(slope(0), 0, kRoundoff);
}

// A tooth that is turned and a gear that is moved have the same flanks as deviations say, to second order.
TEST_F(Modification, index_deviations_turn_teeth_and_eccentricities_move_them) {
  const double f = 0.5e-6, second_order = 2e-11;  // m
  for (const Flank& flank : {left, right}) {
    const Point p = point(t, flank, 0.4 * profile, 3e-3);
    d.index = Eigen::VectorXd::Zero(t.z);
    d.index[3] = f;
    d.eccentricity.setZero();
    Toothing turned = t;
    turned.theta_1 += f / t.r;
    EXPECT_NEAR(flank_deviation(t, d, flank, p.x), flank_distance_along(turned, flank, p.x, p.n),
                second_order);
    d.index.resize(0);
    d.eccentricity = {0.3e-6, -0.4e-6};
    const Vector3d back = p.x - Vector3d(0.3e-6, -0.4e-6, 0);
    EXPECT_NEAR(flank_deviation(t, d, flank, p.x), flank_distance_along(t, flank, back, p.n), second_order);
  }
}

TEST_F(Modification, topographies_are_linear_between_their_points) {
  const double begin = length_of_roll(t, t.r_start);
  Topography measured{.tooth = 3, .side = 1, .roll = {}, .z = {}, .height = {}};
  measured.roll = Eigen::Vector3d(begin, begin + 0.5 * profile, begin + profile);
  measured.z = Eigen::Vector2d(-kWidth / 2, kWidth / 2);
  measured.height = (Eigen::Matrix<double, 3, 2>() << 0, 4e-6, 2e-6, 6e-6, 0, 0).finished();
  d.topography = {measured};
  EXPECT_NEAR(at(0.25, 0), 3e-6, kRoundoff);
  EXPECT_NEAR(at(0.5, kWidth / 4), 5e-6, kRoundoff);
  EXPECT_NEAR(at(0.5, kWidth), 6e-6, kRoundoff);
  EXPECT_EQ(at(0.5, 0, right), 0);
  EXPECT_EQ(at(0.5, 0, {4, 1}), 0);
}

TEST_F(Modification, distances_lead_to_points_beside_the_exact_flank_by_the_deviation) {
  d.left.tip = {20e-6, 0.4 * profile, true};
  d.left.C_beta = 10e-6;
  const Point p = point(t, left, 0.85 * profile, 5e-3);
  const double deviation = flank_deviation(t, d, left, p.x);
  const Vector3d on = p.x + deviation * p.n;
  EXPECT_LT(deviation, -8e-6);
  const Vector3d n = (p.n + 0.1 * Vector3d::UnitZ()).normalized();
  EXPECT_NEAR(flank_distance_along(t, d, left, Vector3d(on - 0.1e-3 * n), n), 0.1e-3, 1e-12);
}

TEST_F(Modification, of_nothing_leaves_flanks_exact_and_teeth_alike) {
  FlankDeviations none;
  none.left.tip.length = 1e-3;
  EXPECT_TRUE(are_exact(none));
  EXPECT_FALSE(teeth_differ(none));
  none.right.C_beta = 1e-6;
  EXPECT_FALSE(are_exact(none));
  EXPECT_FALSE(teeth_differ(none));
  none.index = Eigen::VectorXd::Unit(t.z, 3) * 1e-6;
  EXPECT_TRUE(teeth_differ(none));
}

TEST_F(Modification, refuses_amounts_and_lengths_that_no_flank_has) {
  check("wheel", t, d);
  const auto refused = [&](auto change) {
    FlankDeviations wrong = d;
    change(wrong);
    EXPECT_THROW(check("wheel", t, wrong), Error);
  };
  refused([](auto& w) { w.left.C_beta = 20; });
  refused([](auto& w) { w.right.S_alpha = std::numeric_limits<double>::quiet_NaN(); });
  refused([&](auto& w) { w.left.tip = {10e-6, 1.1 * profile, false}; });
  refused([](auto& w) { w.left.end = {10e-6, 0, false}; });
  refused([](auto& w) { w.eccentricity = {1, 0}; });
  refused([this](auto& w) { w.index = Eigen::VectorXd::Constant(t.z, 1e-2); });
}

}  // namespace
}  // namespace elastogear::gear::modification_test
