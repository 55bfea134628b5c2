// A run of which nothing is left of the theory ends, with a reason and its last sane state.
#include <gtest/gtest.h>

#include "../message_of.h"
#include "box_body.h"
#include "elastogear/base/error.h"
#include "elastogear/body/affine.h"
#include "elastogear/body/rigid.h"
#include "elastogear/dynamics/advice.h"
#include "elastogear/dynamics/static.h"
#include "petsc_option.h"

namespace elastogear::nonsense_test {
using namespace dynamics;
using Eigen::Vector3d;
using test::message_of;

namespace {

// Held at x = 0; without a surface and without markers.
std::shared_ptr<const model::ElasticBody> bare_block() {
  test::BoxSpec spec{.size = {1, 1, 1}, .cells = {2, 1, 1}, .material = {1e4, 0, 1}};
  spec.held = [](const Vector3d& X, int) { return X.x() == 0; };
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal));
  body->surface = {};
  body->surface.Phi = model::DenseRows(0, body->n_q());
  return body;
}

// Under a weight that stretches it by g rho / 2 E of its length in the mean.
System stretched(double g) {
  return System({{.name = "block", .body = bare_block()}}, {}, {.gravity = {g, 0, 0}});
}

double mean_stretch(const model::Snapshot& now) {
  const Eigen::VectorXd G = body::mean_gradient(bare_block()->inertia) * now.bodies[0].q;
  return G[0];
}

// A mass on a slide, pushed in the midst of each step of 0.1 s and never at its ends: the loads' work, by the
// forces at the ends, is zero.
System pushed_between_steps() {
  std::vector<double> times, values;
  for (int i = 0; i <= 400; ++i) {
    times.push_back(0.05 * i);
    values.push_back(i % 2);
  }
  MarkerSetups markers;
  markers.loads.push_back({.name = "push",
                           .marker = {"mass", model::kFrameMarker},
                           .force = {1, 0, 0},
                           .signal = table_signal(times, values)});
  const auto mass = std::make_shared<model::ElasticBody>(
      body::rigid_body(1, Vector3d::Zero(), Eigen::Matrix3d::Identity()));
  return System(
      {{.name = "mass", .body = mass, .joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}}}}, {},
      {}, markers);
}

TEST(Nonsense, of_strains_ends_a_run_of_a_body_without_surface_with_its_last_sane_state) {
  System system = stretched(2e4);  // to a mean stretch of 1 at rest, of 2 in the swing
  std::vector<model::Snapshot> seen;
  std::vector<std::vector<double>> kept;
  Checkpoints checkpoints{.every = 1e9};
  checkpoints.keep = [&](const auto& state) { kept.push_back(state); };
  const std::string message = message_of([&] {
    simulate(
        system, {.dt = 1e-4, .end_time = 0.1, .output_every = 1000},
        [&](const model::Snapshot& now) { seen.push_back(now); }, {}, checkpoints);
  });
  EXPECT_NE(message.find("body 'block' at t = "), std::string::npos) << message;
  EXPECT_NE(message.find("elastic rotation or strain"), std::string::npos) << message;
  ASSERT_EQ(seen.size(), 2u);  // the start, and the last before
  EXPECT_GT(mean_stretch(seen.back()), 0.4);
  EXPECT_LE(mean_stretch(seen.back()), 0.5);
  EXPECT_TRUE(kept.empty());
}

TEST(Nonsense, of_strains_ends_a_static_analysis_with_its_last_sane_state) {
  std::vector<BodySetup> setups{{.name = "block", .body = bare_block()}};
  Environment environment{.gravity = {2e4, 0, 0}};
  scale_by_load_factor(environment);
  System system(setups, {}, environment);
  std::vector<model::Snapshot> seen;
  const std::string message = message_of(
      [&] { solve_static(system, {10}, [&](const model::Snapshot& now) { seen.push_back(now); }); });
  EXPECT_NE(message.find("elastic rotation or strain"), std::string::npos) << message;
  ASSERT_GT(seen.size(), 2u);
  EXPECT_LT(seen.back().time, 0.6);
}

TEST(Nonsense, is_warned_of_from_a_twentieth_on) {
  System system = stretched(2e3);  // 0.1 at rest
  ValidityGuard guard(system);
  std::vector<double> warned;
  simulate(system, {.dt = 1e-4, .end_time = 0.03}, [&](const model::Snapshot& now) {
    if (!guard.warnings(now).empty()) warned.push_back(mean_stretch(now));
  });
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_NEAR(warned[0], 0.05, 0.005);
}

TEST(Nonsense, of_energy_that_comes_from_nowhere_ends_the_run) {
  System system = pushed_between_steps();
  std::vector<double> times;
  const std::string message = message_of([&] {
    simulate(system, {.dt = 0.1, .end_time = 20},
             [&](const model::Snapshot& now) { times.push_back(now.time); });
  });
  EXPECT_NE(message.find("energy balance is off"), std::string::npos) << message;
  EXPECT_LT(times.back(), 2);
}

TEST(Nonsense, is_not_what_a_strongly_damped_scheme_takes_away) {
  System system = stretched(200);
  const RunSummary run = simulate(system, {.dt = 0.01, .end_time = 1, .rho_inf = 0}, {});
  EXPECT_TRUE(run.complete);
  EXPECT_GT(run.largest_imbalance, 0.1 * run.work);
}

TEST(StepLimit, leaves_a_run_that_is_not_complete_and_can_go_on) {
  std::vector<double> state;
  Checkpoints checkpoints{.every = 1e9};
  checkpoints.keep = [&](const auto& s) { state = s; };
  {
    const test::Option limit("-ts_max_steps", "3");
    System system = stretched(1);
    const RunSummary run = simulate(system, {.dt = 1e-3, .end_time = 0.01}, {}, {}, checkpoints);
    EXPECT_FALSE(run.complete);
    EXPECT_TRUE(run.out_of_steps);
    EXPECT_EQ(run.steps, 3);
  }
  ASSERT_FALSE(state.empty());
  System system = stretched(1);
  const RunSummary run = simulate(system, {.dt = 1e-3, .end_time = 0.01}, {}, {}, {.state = state});
  EXPECT_TRUE(run.complete);
  EXPECT_EQ(run.steps, 10);
}

TEST(StepLimit, that_is_just_enough_completes_the_run) {
  const test::Option limit("-ts_max_steps", "10");
  System system = stretched(1);
  EXPECT_TRUE(simulate(system, {.dt = 1e-3, .end_time = 0.01}, {}).complete);
}

}  // namespace
}  // namespace elastogear::nonsense_test
