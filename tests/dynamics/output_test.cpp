// Output at given times, and steps chosen by tolerances in lengths.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "box_body.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::output_test {
using namespace dynamics;

namespace {

// A heavy rigid box on a hinge along y through the origin: a pendulum that swings about z = down by phi0
// cos(w t).
struct Pendulum {
  static constexpr double g = 9.81, phi_0 = 1e-3;
  std::shared_ptr<const model::ElasticBody> body = std::make_shared<model::ElasticBody>(
      test::make_rigid_box({.corner = {-0.5, -0.5, -2}, .size = {1, 1, 1}, .material = {1, 0, 1}}));
  double omega = std::sqrt(body->inertia.m * g * 1.5 / body->inertia.J(1, 1));

  System system() const {
    return System({{.name = "box",
                    .body = body,
                    .joint = {.type = body::JointType::revolute, .axis = {0, 1, 0}},
                    .rotation = {.s_0 = phi_0}}},
                  {}, {.gravity = {0, 0, -g}});
  }
  double angle(double t) const { return phi_0 * std::cos(omega * t); }
};

std::vector<model::Snapshot> snapshots(System system, const TimeSettings& settings,
                                       RunSummary* summary = nullptr) {
  std::vector<model::Snapshot> seen;
  const RunSummary run = simulate(system, settings, [&](const model::Snapshot& s) { seen.push_back(s); });
  if (summary) *summary = run;
  return seen;
}

// A box flies freely against a wall, 0.5 m away.
System flight() {
  const test::BoxSpec spec{.size = {1, 1, 1}, .material = {100, 0.3, 1}};
  const auto box = std::make_shared<model::ElasticBody>(test::make_rigid_box(spec));
  return System({{.name = "box",
                  .body = box,
                  .joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}},
                  .translation = {.s_dot_0 = 1}},
                 {.name = "wall", .body = box, .joint = {.r_WB0 = {1.5, 0, 0}}}},
                {{"box:wall", {0, 1}, {.depth = 0.2, .friction = {}}}});
}

double largest_error(double dt) {
  const Pendulum pendulum;
  double error = 0;
  for (const auto& s : snapshots(pendulum.system(), {.dt = dt, .end_time = 2, .output_dt = 0.013}))
    error = std::max(error, std::abs(s.bodies[0].s[0] - pendulum.angle(s.time)));
  return error;
}

TEST(Output, comes_at_the_given_times_and_at_the_end) {
  const auto seen = snapshots(Pendulum().system(), {.dt = 0.01, .end_time = 1, .output_dt = 0.03});
  ASSERT_EQ(seen.size(), 35u);
  for (std::size_t i = 0; i + 1 < seen.size(); ++i) EXPECT_NEAR(seen[i].time, 0.03 * double(i), 1e-12);
  EXPECT_EQ(seen.back().time, 1);
}

TEST(Output, comes_at_listed_times_between_start_and_end) {
  const std::vector<double> times = {0, 0.01, 0.0337, 0.034, 0.5};
  const auto seen = snapshots(Pendulum().system(), {.dt = 0.01, .end_time = 1, .output_times = times});
  ASSERT_EQ(seen.size(), times.size() + 1);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(seen[i].time, times[i], 1e-12);
  EXPECT_EQ(seen.back().time, 1);
}

TEST(Output, refuses_times_that_do_not_ascend_or_lie_outside_the_run) {
  for (const std::vector<double>& times : {std::vector{0.2, 0.1}, {0.1, 0.1}, {-0.1, 0.1}, {0.1, 1.1}})
    EXPECT_THROW(snapshots(Pendulum().system(), {.dt = 0.01, .end_time = 1, .output_times = times}), Error);
  EXPECT_THROW(
      snapshots(Pendulum().system(), {.dt = 0.01, .end_time = 1, .output_dt = 0.1, .output_times = {0.5}}),
      Error);
}

TEST(Output, between_steps_is_of_second_order) {
  EXPECT_NEAR(std::log2(largest_error(0.04) / largest_error(0.02)), 2, 0.1);
}

TEST(Output, between_steps_has_the_velocity_of_the_motion) {
  const Pendulum pendulum;
  for (const auto& s : snapshots(pendulum.system(), {.dt = 0.01, .end_time = 1, .output_dt = 0.0037})) {
    const double speed = -pendulum.phi_0 * pendulum.omega * std::sin(pendulum.omega * s.time);
    const double acceleration = -pendulum.omega * pendulum.omega * pendulum.angle(s.time);
    EXPECT_NEAR(s.bodies[0].s_dot[0], speed, 2e-3 * pendulum.phi_0 * pendulum.omega);
    EXPECT_NEAR(s.bodies[0].s_ddot[0], acceleration, 5e-3 * pendulum.phi_0 * std::pow(pendulum.omega, 2));
  }
}

// An elastic box that is pressed slowly, in long steps, onto a wall which is stiffer by far: contact begins
// within a step.
System press(double speed) {
  const test::BoxSpec spec{
      .size = {1, 1, 1}, .cells = {2, 1, 1}, .material = {1e4, 0.3, 1}, .held = [](const auto& X, int) {
        return X[0] == 0;
      }};
  const auto box = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::full));
  const auto wall = std::make_shared<model::ElasticBody>(test::make_rigid_box(spec));
  BodySetup ram{.name = "ram", .body = box, .joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}}};
  ram.translation.drive = speed_drive(0, speed);
  PairSetup pair{"ram:wall", {0, 1}, {.depth = 0.2, .friction = {}}};
  pair.settings.stiffness = 1e7;
  return System({ram, {.name = "wall", .body = wall, .joint = {.r_WB0 = {1.003, 0, 0}}}}, {pair});
}

TEST(Output, between_steps_has_the_forces_of_steps_that_end_there) {
  constexpr double kEnd = 1e3, kStep = kEnd / 8, kOutput = kEnd / 32;  // s
  const auto seen =
      snapshots(press(1e-5), {.dt = kStep, .end_time = kEnd, .rho_inf = 0, .output_dt = kOutput});
  const auto steps = snapshots(press(1e-5), {.dt = kOutput, .end_time = kEnd, .rho_inf = 0});
  ASSERT_EQ(seen.size(), 33u);
  ASSERT_EQ(steps.size(), seen.size());
  const double largest = steps.back().pairs[0].force.norm();
  ASSERT_GT(largest, 10);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_NEAR(seen[i].time, steps[i].time, 1e-9);
    EXPECT_LT((seen[i].pairs[0].force - steps[i].pairs[0].force).norm(), 1e-6 * largest) << seen[i].time;
    EXPECT_NEAR(seen[i].energy.elastic, steps[i].energy.elastic, 1e-6 * steps.back().energy.elastic);
  }
}

// The box vibrates from its sudden motion on, which long steps do not resolve: forces swing from step to
// step.
TEST(Output, leaves_the_ledger_of_energy_as_it_is) {
  const auto seen = snapshots(press(1), {.dt = 4e-3, .end_time = 0.08, .output_dt = 3e-3});
  const auto steps = snapshots(press(1), {.dt = 4e-3, .end_time = 0.08});
  ASSERT_GT(steps.back().energy.work, 0);
  EXPECT_NEAR(seen.back().energy.work, steps.back().energy.work, 1e-12 * steps.back().energy.work);
  EXPECT_NEAR(seen.back().energy.balance, steps.back().energy.balance, 1e-12 * steps.back().energy.work);
}

// Velocity and acceleration at the outputs, of a method whose acceleration lags.
TEST(Output, between_steps_with_dissipation_is_of_second_order) {
  const Pendulum pendulum;
  const auto errors = [&](double dt) {
    Eigen::Vector2d error(0, 0);
    for (const auto& s :
         snapshots(pendulum.system(), {.dt = dt, .end_time = 2, .rho_inf = 0.2, .output_dt = 0.013})) {
      const double speed = -pendulum.phi_0 * pendulum.omega * std::sin(pendulum.omega * s.time);
      error[0] = std::max(error[0], std::abs(s.bodies[0].s[0] - pendulum.angle(s.time)));
      error[1] = std::max(error[1], std::abs(s.bodies[0].s_dot[0] - speed));
    }
    return error;
  };
  const Eigen::Vector2d coarse = errors(0.04), fine = errors(0.02);
  EXPECT_NEAR(std::log2(coarse[0] / fine[0]), 2, 0.1);
  EXPECT_NEAR(std::log2(coarse[1] / fine[1]), 2, 0.1);
}

// The local error per step is a length: ten times less of it takes about 10^(1/3) times the steps.
TEST(StepControl, keeps_the_local_error_below_a_length) {
  const Pendulum pendulum;
  RunSummary coarse, fine;
  const TimeSettings settings{.dt = 1e-3, .end_time = 5, .step_tolerance = 1e-6};
  TimeSettings finer = settings;
  finer.step_tolerance = 1e-7;
  double error = 0;
  for (const auto& s : snapshots(pendulum.system(), settings, &coarse))
    error = std::max(error, std::abs(s.bodies[0].s[0] - pendulum.angle(s.time)));
  snapshots(pendulum.system(), finer, &fine);
  EXPECT_LT(error * 2, coarse.steps * settings.step_tolerance) << "2 m from the hinge";
  EXPECT_LT(coarse.steps, 1000);
  EXPECT_NEAR(double(fine.steps) / coarse.steps, std::cbrt(10), 0.3);
}

// A cantilever that begins to hang down swings about its static deflection.
TEST(StepControl, steps_without_a_size_keep_the_error_below_a_share_of_the_displacement) {
  const test::BoxSpec spec{.size = {4, 1, 1},
                           .cells = {4, 1, 1},
                           .material = {100, 0.3, 1},
                           .held = [](const Eigen::Vector3d& X, int) { return X[0] == 0; }};
  const auto box = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal, 6));
  const auto swing = [&](TimeSettings settings, RunSummary& run) {
    settings.end_time = 20;
    settings.output_dt = 1;
    std::vector<Eigen::VectorXd> q;
    BodySetup pulled{.name = "box", .body = box};
    for (const auto& s : snapshots(System({pulled}, {}, {.gravity = {0, 0, -1e-4}}), settings, &run))
      q.push_back(s.bodies[0].q);
    return q;
  };
  RunSummary run, fine_run;
  const auto fine = swing({.dt = 1e-3}, fine_run), chosen = swing({.step_error = 1e-3}, run);
  ASSERT_EQ(fine.size(), chosen.size());
  double error = 0, largest = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    error = std::max(error, (fine[i] - chosen[i]).norm());
    largest = std::max(largest, fine[i].norm());
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(error, 0.1 * largest);
  EXPECT_LT(run.steps, fine_run.steps / 10);
  const auto finer = swing({.step_error = 1e-5}, run);
  double finer_error = 0;
  for (std::size_t i = 0; i < fine.size(); ++i)
    finer_error = std::max(finer_error, (fine[i] - finer[i]).norm());
  EXPECT_LT(finer_error, error / 5);
}

// No step is longer than the contact depth, 0.2 m, over the speed, 1 m/s, though nothing bends or turns.
TEST(StepControl, no_step_takes_surfaces_past_each_other) {
  std::vector<double> at{0};
  for (const auto& s : snapshots(flight(), {.end_time = 1})) at.push_back(s.time);
  ASSERT_GT(at.size(), 5u);
  for (std::size_t i = 1; i < at.size(); ++i) EXPECT_LE(at[i] - at[i - 1], 0.2 * (1 + 1e-12));
}

TEST(StepControl, first_touch_is_not_deep) {
  double first = 0;
  RunSummary summary;
  const TimeSettings settings{.dt = 0.01, .end_time = 1, .step_tolerance = 1e-3};
  for (const auto& s : snapshots(flight(), settings, &summary)) {
    if (first == 0) first = s.pairs[0].penetration;
  }
  EXPECT_GT(summary.rejected_steps, 0);
  EXPECT_GT(first, 0);
  EXPECT_LE(first, 0.1 * 0.2 * (1 + 1e-9));
}

TEST(Monitor, tells_of_every_step) {
  std::vector<StepInfo> told;
  TimeSettings settings{.dt = 0.01, .end_time = 0.1, .output_every = 100};
  settings.monitor = [&](const StepInfo& info) { told.push_back(info); };
  snapshots(Pendulum().system(), settings);
  ASSERT_EQ(told.size(), 11u);
  EXPECT_EQ(told[3].step, 3);
  EXPECT_NEAR(told[3].time, 0.03, 1e-15);
  EXPECT_EQ(told[3].dt, 0.01);
  EXPECT_GE(told[10].newton_iterations, 10);
}

}  // namespace
}  // namespace elastogear::output_test
