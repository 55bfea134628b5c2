#include "evaluation/losses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rigid_drives.h"

namespace elastogear::evaluation::losses_test {
namespace {

constexpr double kForce = 1000, kMu = 0.06, kOmega = 50;  // N, -, rad/s

// A contact at x with the flank of `tooth` of the second gear through it, friction along the sliding.
FlankContact rubbing(const test::RollingPair& pair, const Eigen::Vector3d& x, const Eigen::Vector3d& n,
                     double mu) {
  FlankContact c{.flank = {}, .x_B = {}, .x_W = x, .n = n, .f = {}};
  const Eigen::Vector3d v = sliding_velocity(pair.gear[0], pair.gear[1], 0, x, n, kOmega);
  c.f = kForce * n;
  if (v.norm() > 0) c.f += mu * kForce * v.normalized();
  c.normal_force = kForce;
  c.pressure = 1e8;
  return c;
}

Losses losses_of(const test::RollingPair& pair, const FlankContact& c, double omega) {
  const Eigen::Matrix3Xd force = c.f, torque = c.x_W.cross(c.f);
  return losses(pair.both(), {{c}}, force, torque, omega);
}

TEST(Losses, of_spur_gears_are_friction_times_sliding_and_what_is_missing_in_the_output) {
  const test::RollingPair pair = test::spur_pair();
  const gear::Toothing &a = pair.gear[0].toothing, &b = pair.gear[1].toothing;
  const double distance = pair.gear[1].position[0][0], alpha_w = std::acos((a.r_b + b.r_b) / distance);
  // The driver turns counter-clockwise and pushes its mate, whose centre is on +X, along the line of action.
  const Eigen::Vector3d n(std::sin(alpha_w), std::cos(alpha_w), 0), pitch_point(distance * 17 / 60, 0, 0);
  const double xi = 3e-3, v = kOmega * (1 + 17.0 / 43) * xi;
  const Losses losses = losses_of(pair, rubbing(pair, pitch_point + xi * n, n, kMu), kOmega);
  EXPECT_NEAR(losses.sliding_speed[0], v, 1e-12);
  EXPECT_NEAR(losses.pv[0], 1e8 * v, 1e-3);
  EXPECT_NEAR(losses.friction[0], kMu * kForce * v, 1e-9);
  EXPECT_NEAR(losses.input[0] - losses.output[0], losses.friction[0], 1e-9);
  EXPECT_NEAR(efficiency(losses), 1 - friction_loss(losses), 1e-12);
  EXPECT_NEAR(loss_factor(losses) * kMu, friction_loss(losses), 1e-12);
  const Losses smooth = losses_of(pair, rubbing(pair, pitch_point + xi * n, n, 0), kOmega);
  EXPECT_NEAR(smooth.input[0], kForce * a.r_b * kOmega, 1e-9);
  EXPECT_NEAR(efficiency(smooth), 1, 1e-12);
  EXPECT_NEAR(loss_factor(smooth), v / (a.r_b * kOmega), 1e-12);
}

// The worm drives by tan(gamma)/tan(gamma + rho'), is driven by tan(gamma - rho')/tan(gamma), with
// rho' = atan(mu/cos(alpha_n)), at the pitch point.
TEST(Efficiency, of_a_worm_drive_at_the_pitch_point) {
  const test::RollingPair pair = test::worm_pair();
  const gear::Geometry g = gear::derive(gear::Design{});
  const Gear& wheel = pair.gear[1];
  const Eigen::Vector3d x(0, wheel.toothing.r, 0);
  const double rho = std::atan(kMu / std::cos(gear::Design{}.alpha_n));
  for (int side : {1, -1}) {
    // The flank of the wheel through the pitch point.
    const double psi = gear::psi(wheel.toothing, wheel.toothing.r);
    const Eigen::Matrix3d R = wheel.rotation[0];
    Eigen::Vector3d x_B = R.transpose() * x;
    Gear turned = wheel;
    const double tooth = gear::tooth_angle(wheel.toothing, 0) + side * psi, at = std::atan2(x_B[1], x_B[0]);
    turned.rotation[0] = R * rotation_matrix(Eigen::Vector3d(0, 0, at - tooth));
    x_B = turned.rotation[0].transpose() * x;
    ASSERT_LT(std::abs(gear::flank_distance(wheel.toothing, 0, side, x_B)), 1e-12);
    const Eigen::Vector3d n = -(turned.rotation[0] * gear::flank_normal(wheel.toothing, {0, side}, x_B));
    for (double omega : {kOmega, -kOmega}) {
      FlankContact c = rubbing(pair, x, n, 0);
      const Eigen::Vector3d v = sliding_velocity(pair.gear[0], wheel, 0, x, n, omega);
      c.f += kMu * kForce * v.normalized();
      const double eta = efficiency(losses_of(pair, c, omega));
      const bool worm_drives = losses_of(pair, c, omega).input[0] > 0;
      const double expected = worm_drives ? std::tan(g.gamma) / std::tan(g.gamma + rho)
                                          : std::tan(g.gamma - rho) / std::tan(g.gamma);
      EXPECT_NEAR(friction_loss(losses_of(pair, c, omega)), 1 - expected, 1e-9);
      EXPECT_NEAR(eta, expected, 1e-9) << "side " << side << ", " << omega << " rad/s";
    }
  }
}

TEST(Efficiency, is_none_without_power) {
  const test::RollingPair pair = test::spur_pair();
  EXPECT_TRUE(
      std::isnan(efficiency(losses(pair.both(), {{}}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 1))));
}

}  // namespace
}  // namespace elastogear::evaluation::losses_test
