// Sweeps of a block that rubs on a turntable, against closed forms.
#include "elastogear/dynamics/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../contact/surfaces.h"
#include "../message_of.h"
#include "contact_bodies.h"
#include "elastogear/base/rotation.h"

namespace elastogear::sweep_test {
using namespace dynamics;
using Eigen::Vector3d;
using std::numbers::pi;
using test::message_of;

namespace {

constexpr double kMu = 0.3, kForce = 20, kRate = 0.1;  // -, N, rad

model::Surface shifted(model::Surface s, const Vector3d& by) {
  s.X.colwise() += by;
  return s;
}

// A plate, its upper side at z = 0 and its middle at the origin, that turns about z under a block of 1 m x 1
// m with 3 x 3 nodes, which is pressed down at `place`.
SlowMotion turntable(const Vector3d& place, double length, double width) {
  BodySetup table{.name = "table",
                  .body = test::rigid_with(
                      shifted(contact::test::plane(4, 4, length, width), {-length / 2, -width / 2, 0}))},
      block{.name = "block",
            .body = test::rigid_with(
                shifted(contact::test::flipped(contact::test::plane(2, 2)), {-0.5, -0.5, 0}))};
  table.joint = {.type = body::JointType::revolute};
  table.rotation.drive = speed_drive(0, 0);
  block.joint = {.type = body::JointType::prismatic, .axis = {0, 0, 1}, .r_WB0 = place};
  block.translation.load = constant_signal(-kForce);
  PairSetup pair{"block:table", {1, 0}, {}};
  pair.settings.stiffness = 1e6;
  pair.settings.depth = 0.05;
  pair.settings.penalty = contact::Penalty::per_area;
  pair.settings.friction = {.mu = kMu, .v_0 = 1e-5 * kRate};
  return {.bodies = {table, block}, .pairs = {pair}, .rate = {kRate, 0}};
}

struct Swept {
  std::vector<model::Snapshot> found;
  SweepSummary summary;
};

Swept swept(const SlowMotion& motion, const SweepSettings& settings) {
  Swept swept;
  swept.summary =
      sweep(motion, settings, [&](const model::Snapshot& snapshot) { swept.found.push_back(snapshot); });
  return swept;
}

// N m, of friction under equal pressure on the block: each node bears its share of the area.
double torque_of_friction(const Vector3d& place) {
  double sum = 0;
  for (int i : {-1, 0, 1})
    for (int j : {-1, 0, 1})
      sum += kMu * kForce / 16 * (i == 0 ? 2 : 1) * (j == 0 ? 2 : 1) *
             std::hypot(place.x() + 0.5 * i, place.y() + 0.5 * j);
  return sum;
}

TEST(Sweep, turns_against_friction_that_opposes_the_motion) {
  const Vector3d place(1.2, 0.1, 0);
  const double torque = torque_of_friction(place);
  const Swept forth = swept(turntable(place, 4, 4), {.positions = {-1, 0, 2, 2.5}});
  ASSERT_EQ(forth.found.size(), 4u);
  EXPECT_TRUE(forth.summary.run.complete);
  EXPECT_EQ(forth.summary.restarts, 0);
  for (const model::Snapshot& snapshot : forth.found) {
    EXPECT_NEAR(snapshot.bodies[0].s[0], kRate * snapshot.time, 1e-14);
    EXPECT_NEAR(snapshot.bodies[0].joint_force[0], torque, 1e-7 * torque) << snapshot.time;
    EXPECT_EQ(snapshot.bodies[0].s_dot[0], 0);
    const double loss = torque * kRate * (snapshot.time + 1);
    EXPECT_NEAR(snapshot.energy.dissipated, loss, 1e-7 * torque);
    EXPECT_NEAR(snapshot.energy.work, loss, 1e-7 * torque);
    EXPECT_NEAR(snapshot.energy.balance, 0, 1e-7 * torque);
  }
  SlowMotion back = turntable(place, 4, 4);
  back.rate[0] = -kRate;
  EXPECT_NEAR(swept(back, {.positions = {0}}).found[0].bodies[0].joint_force[0], -torque, 1e-7 * torque);
}

TEST(Sweep, counts_energies_from_the_position_that_leads_in) {
  const Vector3d place(1.2, 0.1, 0);
  const Swept whole = swept(turntable(place, 4, 4), {.positions = {0, 1, 2, 3}});
  const Swept rest = swept(turntable(place, 4, 4), {.positions = {2, 3}, .lead_in = 1});
  ASSERT_EQ(rest.found.size(), 2u);
  EXPECT_EQ(rest.found[0].time, 2);
  for (int i : {0, 1})
    EXPECT_NEAR(rest.found[i].energy.work, whole.found[2 + i].energy.work - whole.found[1].energy.work, 1e-7);
}

// Nothing of one sweep is left in a system from which the next one takes what is prepared.
TEST(Sweep, is_the_same_from_a_prepared_system) {
  SlowMotion motion = turntable({1.2, 0.1, 0}, 4, 4);
  const SweepSettings settings{.positions = {0, 1, 2}};
  const Swept anew = swept(motion, settings);
  motion.prepared = prepare(motion);
  for (int time : {1, 2}) {
    const Swept again = swept(motion, settings);
    ASSERT_EQ(again.found.size(), anew.found.size());
    for (std::size_t i = 0; i < anew.found.size(); ++i) {
      EXPECT_EQ(again.found[i].pairs[0].force, anew.found[i].pairs[0].force) << "sweep " << time;
      EXPECT_EQ(again.found[i].bodies[0].joint_force, anew.found[i].bodies[0].joint_force);
      EXPECT_EQ(again.found[i].energy.work, anew.found[i].energy.work);
    }
  }
}

// A quarter of a turn on, the plate does not reach to the block, which nothing holds then.
TEST(Sweep, goes_on_behind_positions_without_an_equilibrium) {
  SlowMotion motion = turntable({0, 1.75, 0}, 2, 4);
  motion.rate[0] = 1;
  const Swept all = swept(motion, {.positions = {0, 0.1, pi / 2, pi, pi + 0.1}});
  ASSERT_EQ(all.summary.missing.size(), 1u);
  EXPECT_EQ(all.summary.missing[0].position, pi / 2);
  EXPECT_NE(all.summary.missing[0].why.find("nothing holds"), std::string::npos)
      << all.summary.missing[0].why;
  EXPECT_TRUE(all.summary.run.complete);
  ASSERT_EQ(all.found.size(), 4u);
  for (std::size_t i : {0u, 1u}) {  // half a turn on the plate looks as it did
    const double torque = all.found[i].bodies[0].joint_force[0];
    EXPECT_NEAR(all.found[2 + i].bodies[0].joint_force[0], torque, 1e-7 * torque);
    EXPECT_NEAR(all.found[2 + i].time, all.found[i].time + pi, 1e-12);
  }
  const double lost = all.found[2].energy.dissipated - all.found[1].energy.dissipated;
  const double mean = 0.5 * (all.found[1].bodies[0].joint_force[0] + all.found[2].bodies[0].joint_force[0]);
  EXPECT_NEAR(lost, mean * (pi - 0.1), 1e-5 * lost) << "by the trapezoidal rule over what is missing";
}

TEST(Sweep, stops_when_asked) {
  int asked = 0;
  const SweepSummary summary =
      sweep(turntable({1.2, 0, 0}, 4, 4), {.positions = {0, 1, 2, 3}}, {}, {}, [&] { return ++asked >= 10; });
  EXPECT_FALSE(summary.run.complete);
  EXPECT_EQ(asked, 10);
}

TEST(Sweep, refuses_what_cannot_be_swept) {
  const auto refusal = [](SlowMotion motion, const SweepSettings& settings) {
    return message_of([&] { sweep(motion, settings, {}); });
  };
  const SlowMotion good = turntable({1.2, 0, 0}, 4, 4);
  EXPECT_NE(refusal(good, {.positions = {0, 1, 1}}).find("must ascend"), std::string::npos);
  EXPECT_NE(refusal(good, {.positions = {0}, .lead_in = 1}).find("must ascend"), std::string::npos);
  EXPECT_NE(refusal(good, {.positions = {}}).find("at least one"), std::string::npos);
  SlowMotion sticking = good;
  sticking.pairs[0].settings.friction.law = contact::FrictionLaw::stick;
  EXPECT_NE(refusal(sticking, {.positions = {0}}).find("regularised"), std::string::npos);
  SlowMotion sliding = good;
  sliding.rate[1] = 1;
  EXPECT_NE(refusal(sliding, {.positions = {0}}).find("revolute"), std::string::npos);
}

}  // namespace
}  // namespace elastogear::sweep_test
