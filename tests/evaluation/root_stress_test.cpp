#include "evaluation/root_stress.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../message_of.h"
#include "rigid_drives.h"

namespace elastogear::evaluation::root_stress_test {
namespace {

// Each tooth of the pinion has a node at either side of its root; tension at the left ones falls with the
// square of the tooth's place.
constexpr double kOpposite = 6;  // pitches
double tension(double place) { return 300e6 * std::exp(-place * place); }

// Of an idler, which another gear presses `compression` times as much at the opposite side.
io::StressSet made_up(const test::RollingPair& pair, double compression = 0) {
  const Gear& gear = pair.gear[0];
  const int z = gear.toothing.z;
  const Eigen::Index n_t = pair.roll.size();
  io::StressSet set{"pinion", "root", {}, {}, {}, {}};
  set.X.resize(3, 2 * z);
  set.stress = Eigen::MatrixXd::Zero(12 * z, n_t);
  set.rankine = set.von_mises = set.error = Eigen::MatrixXd::Zero(2 * z, n_t);
  for (int i = 0; i < 2 * z; ++i) {
    const double angle = gear::tooth_angle(gear.toothing, i / 2) + (i % 2 == 0 ? 0.08 : -0.08);
    set.X.col(i) << gear.toothing.r_f * std::cos(angle), gear.toothing.r_f * std::sin(angle), 0.001;
    set.node.push_back(100 + i);
    for (Eigen::Index step = 0; step < n_t; ++step) {
      const double place = place_of_tooth(gear, pair.gear[1], i / 2, static_cast<std::size_t>(step));
      set.rankine(i, step) = i % 2 == 0 ? tension(place) : -1e6;
      set.von_mises(i, step) = i % 2 == 0 ? tension(place) : 1.2 * tension(place);
      set.error(i, step) = 2e6;
      set.stress(6 * i + 2, step) = tension(place) - compression * tension(place - kOpposite);
    }
  }
  return set;
}

TEST(RootStress, tells_the_largest_tension_of_the_loaded_side_and_the_way_of_a_tooth) {
  const test::RollingPair pair = test::spur_pair();
  const RootStress stress = root_stress(made_up(pair), pair.gear[0], pair.gear[1], 1);
  EXPECT_EQ(stress.tooth.size(), 17);
  EXPECT_NEAR(stress.largest_tension.value, 300e6, 1);  // tooth 1 stands on the line to its mate at first
  EXPECT_EQ(stress.largest_tension.tooth, 0);
  EXPECT_EQ(stress.largest_tension.node, 100);
  EXPECT_EQ(stress.largest_tension.step, 0);
  EXPECT_EQ(stress.largest_tension.error, 2e6);
  EXPECT_NEAR(stress.largest_von_mises.value, 360e6, 1);
  EXPECT_EQ(stress.largest_von_mises.node, 101);
  ASSERT_EQ(stress.way.size(), 17 * 8);
  for (const ToothStress& s : stress.way) {
    EXPECT_NEAR(s.tension, tension(s.place), 1);
    EXPECT_NEAR(s.von_mises, 1.2 * tension(s.place), 1);
  }
  EXPECT_NEAR(stress.range, 300e6 - tension(8.5), 1e3);
  EXPECT_NEAR(stress.tension(3, 0), tension(3.0 / 8), 1);
}

TEST(RootStress, is_at_the_first_of_nodes_that_bear_the_same_but_for_roundoff) {
  const test::RollingPair pair = test::spur_pair();
  io::StressSet set = made_up(pair);
  const auto node = [&] { return root_stress(set, pair.gear[0], pair.gear[1], 1).largest_tension.node; };
  set.rankine(2, 0) = 300e6 * (1 + 1e-8);
  EXPECT_EQ(node(), 100);
  set.rankine(2, 0) = 300e6 * (1 + 1e-5);
  EXPECT_EQ(node(), 102);
}

TEST(RootStress, ranges_over_tension_and_compression) {
  const test::RollingPair pair = test::spur_pair();
  const RootStress stress = root_stress(made_up(pair, 0.9), pair.gear[0], pair.gear[1], 1);
  EXPECT_NEAR(stress.largest_tension.value, 300e6, 1);
  EXPECT_NEAR(stress.range, 1.9 * 300e6, 1e3);
}

TEST(RootStress, of_the_other_side_is_small) {
  const test::RollingPair pair = test::spur_pair();
  EXPECT_NEAR(root_stress(made_up(pair), pair.gear[0], pair.gear[1], -1).largest_tension.value, -1e6, 1);
}

// The node of the largest tension lies beside a patch at the first position, and the one of the next tooth at
// the form circle.
TEST(RootStress, leaves_out_nodes_beside_contacts_and_at_the_form_circle) {
  const test::RollingPair pair = test::spur_pair();
  io::StressSet set = made_up(pair);
  ContactHistory contacts(static_cast<std::size_t>(pair.roll.size()));
  FlankContact c{};
  c.x_B = {set.X.col(0) + Eigen::Vector3d(0.3e-3, 0, 0), Eigen::Vector3d::Zero()};
  c.normal_force = 100, c.half_width = 0.2e-3;
  contacts[0] = {c};
  set.X.col(2).head<2>() *= pair.gear[0].toothing.r_form / pair.gear[0].toothing.r_f;
  const Beside beside = beside_contacts(set, pair.gear[0], contacts, 0);
  EXPECT_EQ(beside.count(), 1 + pair.roll.size());
  EXPECT_TRUE(beside(0, 0));
  EXPECT_TRUE(beside.row(2).all());
  const RootStress stress = root_stress(set, pair.gear[0], pair.gear[1], 1, beside);
  EXPECT_EQ(stress.tension(0, 0), 0);
  EXPECT_GT(stress.tension(1, 0), 0);
  EXPECT_EQ(stress.tension.col(1).maxCoeff(), 0);
  EXPECT_LT(stress.largest_tension.value, 299e6);
  contacts[0][0].half_width = 0.1e-3;  // then the node is farther off than two half widths
  EXPECT_FALSE(beside_contacts(set, pair.gear[0], contacts, 0)(0, 0));
}

TEST(RootStress, needs_positions) {
  const test::RollingPair pair = test::spur_pair();
  io::StressSet set = made_up(pair);
  set.X.resize(3, 0);
  EXPECT_NE(test::message_of([&] { root_stress(set, pair.gear[0], pair.gear[1], 1); }).find("no positions"),
            std::string::npos);
}

TEST(NearestFlank, follows_a_helix) {
  gear::Toothing t = test::worm_pair().gear[1].toothing;
  const double z = 0.006, r = t.r;
  for (int tooth : {0, 20, 40})
    for (int side : {1, -1}) {
      const double angle = gear::tooth_angle(t, tooth) + z / t.p + side * 0.01;
      const gear::Flank flank = gear::nearest_flank(t, {r * std::cos(angle), r * std::sin(angle), z});
      EXPECT_EQ(flank.tooth, tooth);
      EXPECT_EQ(flank.side, side);
    }
}

}  // namespace
}  // namespace elastogear::evaluation::root_stress_test
