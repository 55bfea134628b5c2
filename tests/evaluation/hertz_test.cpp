#include "evaluation/load/hertz.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../figures.h"
#include "elastogear/base/error.h"
#include "elastogear/model/hertz.h"
#include "rigid_drives.h"

namespace elastogear::evaluation::hertz_test {
using namespace model;

namespace {

using std::numbers::pi;

constexpr double kCompliance = (1 - 0.09) / 206e9;

// Contact at a point x_W (m) of the flanks that pass through it when both gears are turned a little, the
// first one's on side `side`; force N.
FlankContact contact_at(const test::RollingPair& pair, const Eigen::Vector3d& x_W, int side, double force) {
  FlankContact c;
  c.x_W = x_W;
  c.normal_force = force;
  const auto normal = [&](std::size_t g, int of_side) -> Eigen::Vector3d {
    const Gear& gear = pair.gear[g];
    c.x_B[g] = gear.rotation[0].transpose() * (x_W - gear.position[0]);
    c.flank[g] = {0, of_side};
    return gear.rotation[0] * gear::flank_normal(gear.toothing, c.flank[g], c.x_B[g]);
  };
  c.n = normal(0, side);
  const double left = normal(1, 1).dot(c.n), right = normal(1, -1).dot(c.n);
  c.flank[1].side = left < right ? 1 : -1;
  return c;
}

// The pressure of the C14 gears of the FZG at the pitch point: 5912.1 N over 14 mm, 1347.3 MPa.
TEST(HertzPatch, of_the_c14_gears_at_the_pitch_point) {
  const double alpha = 20 * pi / 180, r_b[] = {36e-3 * std::cos(alpha), 54e-3 * std::cos(alpha)};
  const double working = std::acos((r_b[0] + r_b[1]) / 91.5e-3);
  const double kappa = 1 / (r_b[0] * std::tan(working)) + 1 / (r_b[1] * std::tan(working));
  const HertzPatch line = hertz_line(5912.1 / 14e-3, kappa, 1 / (2 * kCompliance));
  EXPECT_NEAR(line.pressure, 1347.3e6, 0.1e6);
  EXPECT_NEAR(line.half_width, 0.1995e-3, 1e-7);
}

TEST(HertzEllipse, of_nearly_equal_curvatures_is_that_of_a_sphere) {
  constexpr double kR = 0.01, kForce = 100, kE = 1e11;
  const HertzEllipse h = hertz_ellipse(0.5 / kR, 0.5001 / kR, kE);
  const double a = std::cbrt(3 * kForce * kR / (4 * kE));
  EXPECT_NEAR(h.a(kForce), a, 1e-3 * a);
  EXPECT_NEAR(h.pressure(kForce), 1.5 * kForce / (pi * a * a), 1e-3 * h.pressure(kForce));
  EXPECT_NEAR(h.approach(kForce), a * a / kR, 1e-3 * a * a / kR);
}

TEST(HertzEllipse, that_is_long_has_the_pressure_of_its_line_load) {
  constexpr double kE = 1e11, kForce = 1000, kA = 0.01, kB = 100;
  const HertzEllipse h = hertz_ellipse(kA, kB, kE);
  const double w = h.pressure(kForce) * pi / 2 * h.k * h.a(kForce);  // at the middle
  EXPECT_NEAR(hertz_line(w, 2 * kB, kE).pressure, h.pressure(kForce), 1e-3 * h.pressure(kForce));
}

// K. L. Johnson, Contact Mechanics, sections 4.2 (line), 3.4 (circle) and table 4.1 (ellipses), nu = 0.3.
TEST(LargestShear, without_friction_is_that_of_the_closed_forms) {
  const ShearBelow line = largest_shear({1e9, 2e-4}, 0);
  EXPECT_NEAR(line.stress, 0.30028e9, 1e4);
  EXPECT_NEAR(line.depth, 0.78615 * 2e-4, 1e-3 * 2e-4);
  const ShearBelow circle = largest_shear({1e9, 2e-4, 1}, 0);
  const auto on_axis = [](double z) {
    return 0.5 * std::abs(1.3 * (1 - z * std::atan(1 / z)) - 1.5 / (1 + z * z));
  };
  EXPECT_NEAR(circle.stress, 1e9 * on_axis(circle.depth / 2e-4), 2e5);
  EXPECT_NEAR(circle.depth, 0.481 * 2e-4, 0.01 * 2e-4);
  const double table[][3] = {{0.2, 0.322, 0.745}, {0.4, 0.325, 0.665}, {0.8, 0.317, 0.53}};  // table 4.1
  for (const auto& [axes, stress, depth] : table) {
    const ShearBelow ellipse = largest_shear({1e9, 2e-4, axes}, 0);
    const std::string of = "shear below ellipses";
    elastogear::test::figure({of, "largest shear over the largest pressure"}, ellipse.stress / 1e9 - stress,
                             1e-3);
    elastogear::test::figure({of, "its depth over the half width", "%"}, ellipse.depth / 2e-4 - depth, 0.01);
  }
}

// On the surface the shear of a sliding line is mu p_0 wherever there is contact; little friction adds
// little.
TEST(LargestShear, with_friction_rises_to_the_surface) {
  const ShearBelow much = largest_shear({1e9, 2e-4}, 0.5), little = largest_shear({1e9, 2e-4}, 0.05);
  EXPECT_NEAR(much.stress, 0.5e9, 1e6);
  EXPECT_LT(much.depth, 0.02 * 2e-4);
  EXPECT_GT(little.stress, 0.30028e9);
  EXPECT_LT(little.stress, 0.305e9);
  EXPECT_NEAR(little.depth, 0.786 * 2e-4, 0.1 * 2e-4);
}

// Radii of curvature of involutes on the line of action: their sum is its length between the base circles.
TEST(HertzPressure, of_spur_gears_is_that_of_cylinders_under_the_line_load) {
  const test::RollingPair pair = test::spur_pair();
  const double r[] = {pair.gear[0].toothing.r_b, pair.gear[1].toothing.r_b};
  const double a = (pair.gear[1].position[0] - pair.gear[0].position[0]).norm();
  const double working = std::acos((r[0] + r[1]) / a);
  const Eigen::Vector3d pitch_point =
      pair.gear[0].position[0] + Eigen::Vector3d(a * r[0] / (r[0] + r[1]), 0, 0);
  constexpr double kForce = 5000;
  std::vector<FlankContact> contacts;
  const Eigen::VectorXd& z = pair.gear[0].layers;
  const auto n = static_cast<double>(z.size() - 1);
  for (double at : z) {
    const bool is_end = at == z[0] || at == z[z.size() - 1];
    contacts.push_back(
        contact_at(pair, pitch_point + Eigen::Vector3d(0, 0, at), 1, kForce / n * (is_end ? 0.5 : 1)));
  }
  const auto found =
      hertz_pressure(pair.both(), {contacts}, stations(pair.both(), 0, 0, 1), 1 / (2 * kCompliance));
  ASSERT_TRUE(found);
  const double kappa = (1 / r[0] + 1 / r[1]) / std::tan(working);
  const HertzPatch right = hertz_line(kForce / 25e-3, kappa, 1 / (2 * kCompliance));
  EXPECT_NEAR(found->patch.pressure, right.pressure, 1e-4 * right.pressure);
  EXPECT_NEAR(found->patch.half_width, right.half_width, 1e-4 * right.half_width);
  EXPECT_EQ(found->largest[0], found->patch.pressure);
  ContactHistory taken = {contacts};
  take_hertz(pair.both(), stations(pair.both(), 0, 0, 1), 1 / (2 * kCompliance), taken);
  for (const FlankContact& c : taken[0]) {  // the ends of an evenly loaded face as its middle
    EXPECT_NEAR(c.pressure, right.pressure, 1e-4 * right.pressure);
    EXPECT_NEAR(c.half_width, right.half_width, 1e-4 * right.half_width);
  }
}

// Involute helicoids on crossed axes at the pitch point: 14.28 and 11.82 mm across their generators, b/a =
// 0.330; 50 N between bodies of 210 GPa have 798 MPa.
TEST(HertzPressure, of_the_steering_worm_at_the_pitch_point) {
  const test::RollingPair pair = test::worm_pair();
  const Eigen::Vector3d pitch_point(0, pair.gear[1].toothing.r, 0);
  const ContactHistory contacts = {{contact_at(pair, pitch_point, 1, 50)}};
  const FaceStations over_face = stations(pair.both(), 1, 0, 1);
  const auto found = hertz_pressure(pair.both(), contacts, over_face, 210e9 / 0.91 / 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->patch.pressure, 798e6, 8e6);
}

// A patch that reaches beyond the tip of the wheel is not Hertz's.
TEST(HertzPressure, leaves_out_patches_at_the_ends_of_flanks) {
  const test::RollingPair pair = test::worm_pair();
  const gear::Toothing& wheel = pair.gear[1].toothing;
  const FlankContact inside = contact_at(pair, Eigen::Vector3d(0, wheel.r, 0), 1, 50);
  FlankContact at_tip = contact_at(pair, Eigen::Vector3d(0, wheel.r_a - 1e-6, 0), 1, 50);
  const FaceStations over_face = stations(pair.both(), 1, 0, 1);
  at_tip.flank[0].tooth = at_tip.flank[1].tooth = inside.flank[0].tooth + 1;
  EXPECT_FALSE(hertz_pressure(pair.both(), {{at_tip}}, over_face, 210e9 / 0.91 / 2));
  const auto one = hertz_pressure(pair.both(), {{inside}}, over_face, 210e9 / 0.91 / 2);
  const auto both = hertz_pressure(pair.both(), {{inside, at_tip}}, over_face, 210e9 / 0.91 / 2);
  ASSERT_TRUE(one && both);
  EXPECT_EQ(both->patch.pressure, one->patch.pressure);
  EXPECT_EQ(one->left_out, 0);
  EXPECT_EQ(both->left_out, 0.5);
}

}  // namespace
}  // namespace elastogear::evaluation::hertz_test
