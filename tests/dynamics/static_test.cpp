// Static equilibria against beam theory, against springs by hand, and against where a relaxing run comes to
// rest.
#include "elastogear/dynamics/static.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../figures.h"
#include "../message_of.h"
#include "box_body.h"
#include "contact_bodies.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "petsc_option.h"

namespace elastogear::static_test {
using namespace dynamics;
using Eigen::Vector3d;
using test::message_of;

namespace {

constexpr double kNewton = 1e-7;  // relative
constexpr double kEnd = std::numeric_limits<double>::infinity();

std::shared_ptr<const model::ElasticBody> held_block(double x_held) {
  test::BoxSpec spec{.size = {1, 1, 1}, .cells = {2, 1, 1}, .material = {1e4, 0, 1}};
  spec.held = [x_held](const Vector3d& X, int) { return std::abs(X.x() - x_held) < 1e-9; };
  return std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal));
}

// A block of E = 10 kPa on a slide is pushed along x against an equal one that is fixed, `gap` away.
std::vector<BodySetup> press(double gap, double force) {
  std::vector<BodySetup> setups{{.name = "ram", .body = held_block(0)},
                                {.name = "wall", .body = held_block(1)}};
  setups[0].joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}};
  setups[0].translation.load = constant_signal(force);
  setups[1].joint.r_WB0.x() = 1 + gap;
  return setups;
}

PairSetup contact_with(double stiffness) {
  PairSetup pair{"ram:wall", {0, 1}, {}};
  pair.settings.stiffness = stiffness;
  pair.settings.depth = 0.05;
  return pair;
}

System scaled(std::vector<BodySetup> setups, const std::vector<PairSetup>& pairs,
              Environment environment = {}) {
  for (BodySetup& setup : setups) scale_by_load_factor(setup, kEnd);
  scale_by_load_factor(environment);
  return System(setups, pairs, environment);
}

std::vector<model::Snapshot> equilibria(System system, int steps = 4) {
  std::vector<model::Snapshot> found;
  solve_static(system, {steps}, [&](const model::Snapshot& snapshot) { found.push_back(snapshot); });
  return found;
}

// Three springs in series: two blocks E A / l and the penalty over the area.
TEST(Static, pressed_blocks_move_by_the_compliances_in_series) {
  constexpr double kGap = 0.2, kForce = 20, kPenalty = 4e4;
  const auto found = equilibria(scaled(press(kGap, kForce), {contact_with(kPenalty)}));
  ASSERT_EQ(found.size(), 5u);
  EXPECT_EQ(found.back().time, 1);
  const double expected = kGap + kForce * (2 / 1e4 + 1 / kPenalty);
  EXPECT_NEAR(found.back().bodies[0].s[0], expected, kNewton * expected);
  EXPECT_NEAR(found.back().pairs[0].force.x(), kForce, kNewton * kForce);
  EXPECT_EQ(found.back().bodies[0].s_dot[0], 0);
}

// Without a penalty, whatever the stiffness by which the gap is closed.
TEST(Static, augmented_lagrangian_closes_the_gap_of_pressed_blocks) {
  constexpr double kGap = 0.2, kForce = 20, expected = kGap + kForce * 2 / 1e4;
  for (double stiffness : {4e2, 4e4, 4e6}) {
    PairSetup pair = contact_with(stiffness);
    pair.settings.law = contact::ContactLaw::unilateral;
    const auto found = equilibria(scaled(press(kGap, kForce), {pair}));
    EXPECT_NEAR(found.back().bodies[0].s[0], expected, kNewton * expected);
    EXPECT_NEAR(found.back().pairs[0].force.x(), kForce, kNewton * kForce);
    EXPECT_LT(found.back().pairs[0].penetration, 1e-6 * pair.settings.depth);
  }
}

// Rigid bodies meet where their gap is zero, under any load.
TEST(Static, augmented_lagrangian_finds_the_position_of_rigid_bodies) {
  constexpr double kGap = 0.2;
  for (double force : {1e-3, 20., 1e3}) {
    std::vector<BodySetup> setups = press(kGap, force);
    for (BodySetup& setup : setups) setup.body = test::rigid_with(setup.body->surface);
    PairSetup pair = contact_with(4e4);
    pair.settings.law = contact::ContactLaw::unilateral;
    const auto found = equilibria(scaled(setups, {pair}));
    EXPECT_NEAR(found.back().bodies[0].s[0], kGap, 1e-6 * pair.settings.depth);
    EXPECT_NEAR(found.back().pairs[0].force.x(), force, kNewton * force);
  }
}

TEST(Static, asked_to_stop_ends_with_the_last_equilibrium) {
  std::vector<model::Snapshot> found;
  int asked = 0;
  System system = scaled(press(0.2, 20), {contact_with(4e4)});
  const RunSummary run = solve_static(
      system, {4}, [&](const model::Snapshot& snapshot) { found.push_back(snapshot); }, {},
      [&] { return ++asked >= 40; });
  EXPECT_EQ(asked, 40);
  EXPECT_FALSE(run.complete);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(run.time, found.back().time);
  EXPECT_LT(run.time, 1);
}

// Multigrid answers a block of 343 nodes that is pressed obliquely only nearly; GMRES makes that exact.
TEST(Static, multigrid_finds_the_equilibrium_of_the_factor) {
  test::BoxSpec spec{.cells = {6, 6, 6}, .material = {1e4, 0.3, 1}};
  spec.held = [](const Vector3d& X, int) { return std::abs(X.x() - 1) < 1e-9; };
  const auto block = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::full));
  const auto pushed = [&] {
    auto setups = press(0.01, 20);
    setups[1].body = block;
    setups[1].joint.R_WB0 = rotation_matrix(Vector3d(0, 0, 0.02));
    setups[1].joint.r_WB0.y() = -0.1;
    return equilibria(scaled(setups, {contact_with(4e4)})).back();
  };
  const model::Snapshot expected = pushed();
  const test::Option multigrid("-elastic_pc_type", "gamg"), tolerance("-ksp_rtol", "1e-6");
  const model::Snapshot found = pushed();
  const std::string of = "multigrid, block";
  test::figure({of, "displacement"}, found.bodies[0].s[0] / expected.bodies[0].s[0] - 1, kNewton);
  test::figure({of, "deformation"},
               (found.bodies[1].q - expected.bodies[1].q).norm() / expected.bodies[1].q.norm(), kNewton);
}

TEST(Static, forces_grow_with_the_load_factor) {
  for (const model::Snapshot& snapshot : equilibria(scaled(press(0.01, 20), {contact_with(4e4)}))) {
    const double expected = 20 * snapshot.time;
    EXPECT_NEAR(snapshot.pairs[0].force.x(), expected, kNewton * expected) << snapshot.time;
  }
}

TEST(Static, prescribed_motion_presses_as_far_as_it_goes) {
  std::vector<BodySetup> setups = press(0, 0);
  setups[0].translation = {.drive = speed_drive(0, 0.002)};
  for (BodySetup& setup : setups) scale_by_load_factor(setup, 5);
  const auto found = equilibria(System(setups, {contact_with(4e4)}));
  const double force = 0.01 / (2 / 1e4 + 1 / 4e4);
  EXPECT_NEAR(found.back().bodies[0].s[0], 0.01, 1e-15);
  EXPECT_NEAR(found.back().pairs[0].force.x(), force, kNewton * force);
  EXPECT_NEAR(found.back().bodies[0].joint_force[0], force, kNewton * force);
}

// A bar hanging from its upper end: rho g l^2 / 2 E at the tip; linear elements are exact at nodes.
TEST(Static, weight_stretches_a_hanging_bar) {
  const auto bar = held_block(0);
  const Vector3d g(10, 0, 0);
  const auto found = equilibria(scaled({{.name = "bar", .body = bar}}, {}, {.gravity = g}));
  const int tip = static_cast<int>(bar->surface.X.cols()) - 1;
  ASSERT_EQ(bar->surface.X(0, tip), 1);
  const double expected = 1 * 10 / (2 * 1e4);
  EXPECT_NEAR(model::displacement(bar->surface.Phi, tip, found.back().bodies[0].q).x(), expected,
              kNewton * expected);
}

TEST(Static, work_of_load_motion_and_weight_is_stored) {
  std::vector<BodySetup> driven = press(0, 0);
  driven[0].translation = {.drive = speed_drive(0, 0.01)};
  for (BodySetup& setup : driven) scale_by_load_factor(setup, 1);
  const double compliance = 2 / 1e4 + 1 / 4e4;
  const auto check = [](const std::vector<model::Snapshot>& found, double work) {
    const model::Energies& energy = found.back().energy;
    EXPECT_NEAR(energy.work, work, kNewton * work);
    EXPECT_NEAR(energy.elastic + energy.contact, work, kNewton * work);
    for (const model::Snapshot& snapshot : found) EXPECT_NEAR(snapshot.energy.balance, 0, kNewton * work);
  };
  check(equilibria(scaled(press(0, 20), {contact_with(4e4)})), 0.5 * 20 * 20 * compliance);
  check(equilibria(System(driven, {contact_with(4e4)})), 0.5 * 0.01 * 0.01 / compliance);
  // A bar of A = l = rho = 1 under g stores (rho g)^2 / 6 E; two linear elements hold 15/16 of it.
  check(equilibria(scaled({{.name = "bar", .body = held_block(0)}}, {}, {.gravity = {10, 0, 0}})),
        15.0 / 16 * 100 / (6 * 1e4));
}

TEST(Static, work_of_a_couple_turns_a_spring) {
  constexpr double kCouple = 1, kSpring = 10;
  constexpr double kTurn = 1e-4;  // relative: Cayley's vector against the angle, step by step
  const auto rigid = std::make_shared<model::ElasticBody>(test::make_rigid_box({.material = {1, 0, 1}}));
  BodySetup body{.name = "a", .body = rigid, .joint = {.type = body::JointType::free}};
  const MarkerName frame{"a", model::kFrameMarker};
  MarkerSetups markers;
  markers.bushings = {{"b", {frame, {}}, {{1, 1, 1}, Vector3d::Constant(kSpring), {0, 0, 0}, {0, 0, 0}}}};
  markers.loads = {{"l", frame, {0, 0, 0}, {0, 0, kCouple}}};
  scale_by_load_factor(body, kEnd);
  scale_by_load_factor(markers, kEnd);
  const auto found = equilibria(System({body}, {}, {}, markers));
  const double work = 0.5 * kCouple * kCouple / kSpring;
  EXPECT_NEAR(found.back().energy.bushing, work, kNewton * work);
  EXPECT_NEAR(found.back().energy.work, work, kTurn * work);
  EXPECT_GT(found.back().energy.work, 0);
}

TEST(Static, names_the_coordinate_that_nothing_holds) {
  const std::string message = message_of([] { equilibria(scaled({press(0, 20)[0]}, {})); });
  EXPECT_NE(message.find("body 'ram': the displacement along its axis"), std::string::npos) << message;
}

TEST(Static, refuses_initial_velocities_and_motions_without_end) {
  std::vector<BodySetup> setups = press(0, 0);
  setups[0].translation.s_dot_0 = 1;
  EXPECT_THROW(scale_by_load_factor(setups[0], kEnd), Error);
  setups[0].translation = {.drive = speed_drive(0, 1)};
  EXPECT_THROW(scale_by_load_factor(setups[0], kEnd), Error);
}

TEST(Relax, comes_to_rest_where_the_static_analysis_ends) {
  const std::vector<model::Snapshot> still = equilibria(scaled(press(0.02, 20), {contact_with(4e4)}));
  System system(press(0.02, 20), {contact_with(4e4)});
  model::Snapshot last;
  const TimeSettings settings{
      .dt = 0.002, .end_time = 20, .rho_inf = 0, .output_every = 1 << 20, .relax = true};
  const RunSummary summary =
      simulate(system, settings, [&](const model::Snapshot& snapshot) { last = snapshot; });
  EXPECT_TRUE(summary.at_rest);
  EXPECT_LT(summary.steps, 2000);
  const double tolerance = 10 * settings.rest_tolerance;
  EXPECT_NEAR(last.bodies[0].s[0], still.back().bodies[0].s[0], tolerance);
  EXPECT_NEAR(last.pairs[0].force.x(), 20, 20 * tolerance);
  EXPECT_LT((last.bodies[1].q - still.back().bodies[1].q).norm(),
            tolerance * still.back().bodies[1].q.norm());
  EXPECT_EQ(last.bodies[0].s_dot[0], 0);
}

TEST(Relax, closes_gaps_by_an_augmented_lagrangian) {
  constexpr double kGap = 0.02, kForce = 20, expected = kGap + kForce * 2 / 1e4;
  PairSetup pair = contact_with(4e4);
  pair.settings.law = contact::ContactLaw::unilateral;
  System system(press(kGap, kForce), {pair});
  model::Snapshot last;
  const RunSummary run = simulate(system, {.dt = 2e-3, .end_time = 20, .rho_inf = 0, .relax = true},
                                  [&](const model::Snapshot& snapshot) { last = snapshot; });
  EXPECT_TRUE(run.at_rest);
  EXPECT_NEAR(last.bodies[0].s[0], expected, 1e-5 * expected);
  EXPECT_LT(last.pairs[0].penetration, 2e-6 * pair.settings.depth);
}

TEST(Relax, says_when_the_time_was_too_short) {
  System system(press(0.02, 20), {contact_with(4e4)});
  const RunSummary summary = simulate(system, {.dt = 0.002, .end_time = 0.02, .relax = true}, {});
  EXPECT_FALSE(summary.at_rest);
  EXPECT_TRUE(summary.complete);
}

}  // namespace
}  // namespace elastogear::static_test
