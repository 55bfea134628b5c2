// What a run promises beside its solution: observers, options, errors, determinism.
#include <gtest/gtest.h>

#include "../message_of.h"
#include "box_body.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/simulate.h"
#include "petsc_option.h"

namespace elastogear::simulate_test {
using namespace dynamics;
using test::message_of;

namespace {

System spinning_rigid_box() {
  const auto body = std::make_shared<model::ElasticBody>(test::make_rigid_box({.material = {1, 0, 1}}));
  return System({{.name = "box",
                  .body = body,
                  .joint = {body::JointType::revolute},
                  .rotation = {.s_dot_0 = 1, .load = constant_signal(1)}}},
                {});
}

// A soft box flies against a rigid one, `gap` away.
System impact(double gap) {
  const test::BoxSpec box{.size = {1, 1, 1}, .cells = {2, 2, 2}, .material = {100, 0.3, 1}};
  const auto soft = std::make_shared<model::ElasticBody>(test::make_box(box, model::Basis::modal));
  const auto wall = std::make_shared<model::ElasticBody>(
      test::make_rigid_box({.corner = {0, -1, -1}, .size = {1, 3, 3}, .material = {100, 0.3, 1}}));
  return System({{.name = "box", .body = soft, .q_dot0 = test::uniform_velocity(*soft, {1, 0, 0})},
                 {.name = "wall", .body = wall, .joint = {.r_WB0 = {1 + gap, 0, 0}}}},
                {{"box:wall", {0, 1}, {}}});
}

std::vector<double> times(System system, const TimeSettings& settings) {
  std::vector<double> times;
  simulate(system, settings, [&](const model::Snapshot& snapshot) { times.push_back(snapshot.time); });
  return times;
}

TEST(Simulate, observes_every_nth_step_and_the_last) {
  const std::vector<double> seen = times(spinning_rigid_box(), {.dt = 0.1, .end_time = 1, .output_every = 3});
  ASSERT_EQ(seen.size(), 5u);  // steps 0 3 6 9 10
  EXPECT_EQ(seen.front(), 0);
  EXPECT_DOUBLE_EQ(seen[1], 0.3);
  EXPECT_DOUBLE_EQ(seen.back(), 1);
}

TEST(Simulate, options_database_wins_over_settings) {
  const test::Option dt("-ts_dt", "0.25");
  EXPECT_EQ(times(spinning_rigid_box(), {.dt = 0.1, .end_time = 1}).size(), 5u);
}

TEST(Simulate, first_snapshot_holds_the_initial_acceleration) {
  System system = spinning_rigid_box();
  std::vector<double> acceleration;
  simulate(system, {.dt = 0.1, .end_time = 0.1},
           [&](const model::Snapshot& s) { acceleration.push_back(s.bodies[0].s_ddot[0]); });
  EXPECT_NEAR(acceleration.front(), 1 / system.bodies()[0].eq.body->inertia.J(2, 2), 1e-12);
}

TEST(Simulate, refuses_settings_that_make_no_sense) {
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = -1, .end_time = 1}), Error);
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = 0, .end_time = 1, .relax = true}), Error);
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = 0, .end_time = 1, .step_error = 0}), Error);
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = NAN, .end_time = 1}), Error);
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = 0.1, .end_time = -1}), Error);
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = 0.1, .end_time = 1, .rho_inf = 1.5}), Error);
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = 0.1, .end_time = 1, .output_every = 0}), Error);
  const test::Option dt("-ts_dt", "-1");
  EXPECT_THROW(times(spinning_rigid_box(), {.dt = 0.1, .end_time = 1}), Error);
}

TEST(Simulate, rethrows_what_the_observer_throws) {
  System system = spinning_rigid_box();
  const std::string message = message_of([&] {
    simulate(system, {.dt = 0.1, .end_time = 1}, [](const model::Snapshot&) { fail("disk full"); });
  });
  EXPECT_EQ(message, "disk full");
}

TEST(Simulate, step_that_cannot_be_cut_further_is_an_error_with_its_time) {
  const test::Option none("-snes_max_it", "0");
  const std::string message = message_of([] { times(impact(0.01), {.dt = 0.1, .end_time = 1}); });
  EXPECT_NE(message.find("cannot be solved"), std::string::npos) << message;
}

TEST(Simulate, bodies_that_begin_inside_each_other_are_refused) {
  const std::string message = message_of([] { times(impact(-0.3), {.dt = 0.01, .end_time = 1}); });
  EXPECT_NE(message.find("box:wall"), std::string::npos) << message;
}

TEST(Simulate, impact_too_fast_for_the_time_step_is_cut_and_recovers) {
  System system = impact(0.01);
  std::vector<double> seen;
  const RunSummary summary =
      simulate(system, {.dt = 0.5, .end_time = 3}, [&](const model::Snapshot& s) { seen.push_back(s.time); });
  EXPECT_GT(summary.rejected_steps, 0);
  EXPECT_GT(summary.pair[0].peak_force, 0);
  EXPECT_DOUBLE_EQ(seen.back(), 3);
}

// The torque about the axis is roundoff of the centrifugal forces: no share of it is out of balance.
TEST(Simulate, free_rotation_begins_with_one_iteration) {
  const auto at = [](double x) {
    const test::BoxSpec box{.corner = {x, 0.1, 0},
                            .cells = {2, 2, 2},
                            .material = {100, 0.3, 1},
                            .held = [x](const Eigen::Vector3d& X, int) { return X[0] == x; }};
    return std::make_shared<model::ElasticBody>(test::make_box(box, model::Basis::full));
  };
  System system(
      {{.name = "spinning", .body = at(0), .joint = {body::JointType::revolute}, .rotation = {.s_dot_0 = 1}},
       {.name = "at rest", .body = at(1.5)}},
      {{"spinning:at rest", {0, 1}, {}}});
  EXPECT_LE(simulate(system, {.dt = 1e-6, .end_time = 1e-6}, {}).newton_iterations, 2);
}

TEST(Simulation, of_single_steps_equals_simulate_to_the_bit) {
  System one = impact(0.01), other = impact(0.01);
  const TimeSettings settings{.dt = 0.005, .end_time = 0.3};
  std::vector<model::Snapshot> seen;
  const RunSummary whole = simulate(one, settings, [&](const model::Snapshot& s) { seen.push_back(s); });
  ASSERT_GT(whole.pair[0].peak_force, 0);
  Simulation simulation(other, settings);
  EXPECT_EQ(simulation.state(), nullptr);
  const std::shared_ptr<const model::Snapshot> first = (simulation.advance(), simulation.state());
  for (const model::Snapshot& expected : seen) {
    EXPECT_EQ(simulation.state()->time, expected.time);
    EXPECT_EQ(simulation.state()->bodies[0].q, expected.bodies[0].q);
    EXPECT_EQ(simulation.state()->bodies[0].q_ddot, expected.bodies[0].q_ddot);
    EXPECT_EQ(simulation.advance(), expected.time < 0.3);
  }
  EXPECT_TRUE(simulation.ended());
  EXPECT_EQ(first->time, 0);  // has stayed
  EXPECT_EQ(simulation.finish().newton_iterations, whole.newton_iterations);
}

TEST(Simulation, may_end_before_its_time) {
  System system = impact(0.01);
  int observed = 0;
  Simulation simulation(system, {.dt = 0.005, .end_time = 0.3, .output_every = 10},
                        [&](const model::Snapshot&) { ++observed; });
  for (int i = 0; i < 13; ++i) EXPECT_TRUE(simulation.advance());
  const RunSummary summary = simulation.finish();
  EXPECT_EQ(summary.steps, 12);
  EXPECT_FALSE(summary.complete);
  EXPECT_EQ(observed, 3);  // steps 0, 10 and the last
  EXPECT_FALSE(simulation.advance());
}

TEST(Simulation, has_ended_after_an_error) {
  System system = spinning_rigid_box();
  Simulation simulation(system, {.dt = 0.1, .end_time = 1}, [](const model::Snapshot& s) {
    if (s.time > 0.25) fail("disk full");
  });
  EXPECT_EQ(message_of([&] {
              while (simulation.advance()) continue;
            }),
            "disk full");
  EXPECT_TRUE(simulation.ended());
  EXPECT_FALSE(simulation.advance());
}

TEST(Simulate, repeats_itself_bit_for_bit) {
  const auto end = [] {
    System system = impact(0.01);
    Eigen::VectorXd q;
    simulate(system, {.dt = 0.005, .end_time = 0.3}, [&](const model::Snapshot& s) { q = s.bodies[0].q; });
    return q;
  };
  EXPECT_EQ(end(), end());
}

}  // namespace
}  // namespace elastogear::simulate_test
