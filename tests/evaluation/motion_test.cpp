#include "elastogear/evaluation/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rigid_drives.h"

namespace elastogear::evaluation::motion_test {
namespace {

using test::RollingPair;

Eigen::VectorXd error_of(const RollingPair& pair, double sense) {
  const int z_1 = pair.gear[0].toothing.z;
  Eigen::VectorXd phi[2];
  for (int g : {0, 1})
    phi[g] = angles(pair.gear[g], nominal_angles(pair.gear[g], z_1, pair.roll)).array() - pair.gear[g].angle;
  return transmission_error(transmission(pair.gear[0], pair.gear[1], sense), phi[0], phi[1]);
}

TEST(TransmissionError, of_perfect_rigid_gears_is_none) {
  for (const RollingPair& pair : {test::spur_pair(), test::worm_pair()})
    EXPECT_LT(error_of(pair, 1).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(TransmissionError, is_the_way_by_which_the_second_gear_leads_in_the_sense_of_the_drive) {
  const double lead = 1e-4;
  for (RollingPair pair : {test::spur_pair(), test::worm_pair()}) {
    test::roll_to(pair, pair.roll, Eigen::VectorXd::Constant(pair.roll.size(), lead));
    const gear::Toothing& second = pair.gear[1].toothing;
    const double radius = pair.gear[0].name == "pinion" ? second.r_b : second.r;
    EXPECT_NEAR(error_of(pair, 1).minCoeff(), radius * lead, 1e-14);
    EXPECT_NEAR(error_of(pair, -1).maxCoeff(), -radius * lead, 1e-14);
  }
}

TEST(ContinuousAngles, follow_a_run_over_many_turns) {
  RollingPair pair = test::spur_pair();
  test::roll_to(pair, Eigen::VectorXd::LinSpaced(200, 0.25, 60));
  for (int g : {0, 1}) {
    const Eigen::VectorXd nominal = nominal_angles(pair.gear[g], 17, pair.roll);
    EXPECT_LT((continuous_angles(pair.gear[g], 17, 0.25) - nominal).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Stiffness, is_force_over_the_change_of_the_error) {
  const Eigen::VectorXd c =
      stiffness(Eigen::Vector2d(10, 10), Eigen::Vector2d(-3e-6, -1e-6), Eigen::Vector2d(-1e-6, -1e-6));
  EXPECT_NEAR(c[0], 5e6, 1e-6);
  EXPECT_TRUE(std::isnan(c[1]));
}

// At the distance xi from the pitch point along the line of action flanks slide at (omega_1 + omega_2) xi.
TEST(SlidingVelocity, of_spur_gears_grows_from_the_pitch_point) {
  const RollingPair pair = test::spur_pair();
  const gear::Toothing &a = pair.gear[0].toothing, &b = pair.gear[1].toothing;
  const double distance = pair.gear[1].position[0][0], alpha_w = std::acos((a.r_b + b.r_b) / distance);
  const double r_w = distance * 17 / 60;
  const Eigen::Vector3d line(std::sin(alpha_w), -std::cos(alpha_w), 0), pitch_point(r_w, 0, 0);
  for (double xi : {-4e-3, 0.0, 3e-3}) {
    const Eigen::Vector3d v =
        sliding_velocity(pair.gear[0], pair.gear[1], 0, pitch_point + xi * line, line, 100);
    EXPECT_NEAR(v.norm(), 100 * (1 + 17.0 / 43) * std::abs(xi), 1e-12);
  }
}

// The worm's flank slides along the wheel's tooth at v_1/cos(gamma) where the pitch cylinders touch.
TEST(SlidingVelocity, of_a_worm_drive_at_the_pitch_point) {
  const RollingPair pair = test::worm_pair();
  const gear::Geometry g = gear::derive(gear::Design{});
  const Eigen::Vector3d x(0, pair.gear[1].toothing.r, 0);
  // In the common plane of the pitch cylinders the flanks' normal is at right angles to the helix.
  const Eigen::Vector3d n =
      Eigen::Vector3d(std::cos(g.gamma), std::tan(gear::Design{}.alpha_n), -std::sin(g.gamma)).normalized();
  const Eigen::Vector3d n_opposite(n[0], n[1], -n[2]);
  const double expected = 100 * g.worm.r / std::cos(g.gamma);
  const double v = sliding_velocity(pair.gear[0], pair.gear[1], 0, x, n, 100).norm(),
               w = sliding_velocity(pair.gear[0], pair.gear[1], 0, x, n_opposite, 100).norm();
  EXPECT_TRUE(std::abs(v - expected) < 1e-9 || std::abs(w - expected) < 1e-9)
      << v << " " << w << " " << expected;
}

TEST(PlaceOfTooth, advances_by_a_pitch_while_the_drive_rolls_by_one) {
  for (RollingPair pair : {test::spur_pair(), test::worm_pair()}) {
    test::roll_to(pair, Eigen::Vector2d(0.1, 0.6));
    for (int g : {0, 1}) {
      const Gear &gear = pair.gear[g], &mate = pair.gear[1 - g];
      const double z = gear.toothing.z;
      for (int tooth = 0; tooth < gear.toothing.z; ++tooth) {
        const double way = place_of_tooth(gear, mate, tooth, 1) - place_of_tooth(gear, mate, tooth, 0);
        EXPECT_NEAR(std::remainder(way - 0.5, z), 0, 1e-9);
      }
    }
    // The first gear's tooth 1 stands on the line to its mate where the roll angle is 0.
    if (pair.gear[0].name == "pinion") {
      EXPECT_NEAR(place_of_tooth(pair.gear[0], pair.gear[1], 0, 0), 0.1, 1e-9);
    }
  }
}

// At its ends the flank is at the radii on the path that are nearest to both roots, where its normal is that
// of the line of action.
TEST(PathOfContact, is_as_long_as_the_contact_ratio_and_ends_at_both_roots) {
  const RollingPair pair = test::spur_pair();
  const gear::Toothing &t = pair.gear[1].toothing, &mate = pair.gear[0].toothing;
  const double a = (pair.gear[1].position[0] - pair.gear[0].position[0]).norm();
  const double alpha_w = std::acos((t.r_b + mate.r_b) / a);
  const auto left = path_of_contact(pair.gear[0], pair.gear[1], 1),
             right = path_of_contact(pair.gear[0], pair.gear[1], -1);
  ASSERT_TRUE(left && right);
  EXPECT_NEAR((*left)[0], -(*right)[1], 1e-12);
  EXPECT_NEAR((*left)[1], -(*right)[0], 1e-12);
  const auto place = [&](double r) {  // of the left flank; the wheel turns clockwise
    return -(std::acos(t.r_b / r) - alpha_w - gear::psi(t, r)) / pitch(pair.gear[1]);
  };
  EXPECT_NEAR((*left)[1], place(t.r_start), 1e-9);
  EXPECT_NEAR((*left)[0], place(t.r_a), 1e-9);
  const double rho_1 = std::sqrt(mate.r_a * mate.r_a - mate.r_b * mate.r_b),
               rho_2 = std::sqrt(t.r_a * t.r_a - t.r_b * t.r_b);
  EXPECT_NEAR((*left)[1] - (*left)[0],
              (rho_1 + rho_2 - a * std::sin(alpha_w)) * 43 / (2 * std::numbers::pi * t.r_b), 1e-9);
  EXPECT_FALSE(path_of_contact(test::worm_pair().gear[0], test::worm_pair().gear[1], 1));
}

}  // namespace
}  // namespace elastogear::evaluation::motion_test
