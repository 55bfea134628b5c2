// Contact without a penalty: the limit of stiff penalties on bodies of the full basis, and impact of bars.
#include <gtest/gtest.h>

#include <cstdio>

#include "../figures.h"
#include "box_body.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/dynamics/static.h"

namespace elastogear::unilateral_contact_test {
using namespace dynamics;
using Eigen::Vector3d;

namespace {

constexpr double kPenetration = 1e-4;  // of the default penalty's, that the law still allows

std::shared_ptr<model::ElasticBody> block(bool flexible, const Eigen::Vector3i& cells, double x_held) {
  const test::BoxSpec spec{
      .size = {1, 1, 1}, .cells = cells, .material = {1e4, 0.3, 1}, .held = [=](const Vector3d& X, int) {
        return std::abs(X.x() - x_held) < 1e-9;
      }};
  return std::make_shared<model::ElasticBody>(flexible ? test::make_flexible_box(spec, 6)
                                                       : test::make_box(spec, model::Basis::full));
}

constexpr double kDefault = 0, kUnilateral = -1, kAugmented = -2;  // in the place of a stiffness

// A block on a slide along x, the ram, before another one, the wall, which it meets beside its middle.
struct Blocks {
  std::vector<BodySetup> setups;
  PairSetup pair{"ram:wall", {0, 1}, {}};
};

Blocks blocks(double stiffness, bool two_pass, double gap) {
  const bool flexible = stiffness == kUnilateral;
  Blocks b{{{.name = "ram", .body = block(flexible, {2, 3, 2}, 0)},
            {.name = "wall", .body = block(flexible, {2, 2, 2}, 1)}}};
  b.setups[0].joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}};
  b.setups[1].joint.r_WB0 = {1 + gap, 0.25, 0.1};
  contact::Settings& settings = b.pair.settings;
  settings.law = stiffness < 0 ? contact::ContactLaw::unilateral : contact::ContactLaw::penalty;
  settings.stiffness = std::max(0., stiffness);
  settings.depth = 0.05;
  settings.two_pass = two_pass;
  settings.extension = 0;
  return b;
}

// The ram is pressed against the wall.
System press(double force, double stiffness, bool two_pass) {
  Blocks b = blocks(stiffness, two_pass, 1e-3);
  b.setups[0].translation.load = constant_signal(force);
  scale_by_load_factor(b.setups[0], std::numeric_limits<double>::infinity());
  return System(b.setups, {b.pair});
}

model::Snapshot equilibrium(System system) {
  model::Snapshot last;
  solve_static(system, {4}, [&](const model::Snapshot& snapshot) { last = snapshot; });
  return last;
}

// With a penalty nodes of both sides, without one the edges of the master, keep a body from being entered
// between the nodes of the other.
TEST(Unilateral, equilibrium_is_the_limit_of_stiff_penalties) {
  const double force = 300, stiff = 1e8;
  const model::Snapshot limit = equilibrium(press(force, stiff, true));
  for (bool two_pass : {false, true}) {
    const model::Snapshot found = equilibrium(press(force, kUnilateral, two_pass));
    std::printf("approach %.7g m, with the stiff penalty %.7g m\n", found.bodies[0].s[0],
                limit.bodies[0].s[0]);
    EXPECT_NEAR(found.bodies[0].s[0], limit.bodies[0].s[0], (two_pass ? 1e-4 : 5e-3) * limit.bodies[0].s[0]);
    EXPECT_NEAR(found.pairs[0].force.x(), force, 1e-6 * force);
    const double soft = 3 * equilibrium(press(force / 3, kDefault, two_pass)).pairs[0].penetration;
    EXPECT_GT(soft, 0);
    EXPECT_LT(found.pairs[0].penetration, 2 * kPenetration * soft);
  }
}

// The augmented Lagrangian closes gaps altogether.
TEST(Unilateral, equilibrium_is_that_of_the_full_basis_by_an_augmented_lagrangian) {
  const double force = 300, few = 1e-3;
  for (bool two_pass : {false, true}) {
    const model::Snapshot found = equilibrium(press(force, kUnilateral, two_pass)),
                          full = equilibrium(press(force, kAugmented, two_pass));
    std::printf("approach %.9g m, with the full basis %.9g m\n", found.bodies[0].s[0], full.bodies[0].s[0]);
    EXPECT_NEAR(found.bodies[0].s[0], full.bodies[0].s[0], kPenetration * full.bodies[0].s[0]);
    EXPECT_LT(full.pairs[0].penetration, 1e-7);
    if (two_pass) continue;  // forces of one place are those of two nodes in any shares
    ASSERT_EQ(found.pairs[0].count, full.pairs[0].count);
    for (std::size_t i = 0; i < found.pairs[0].contacts.size(); ++i)
      EXPECT_LT((found.pairs[0].contacts[i].f - full.pairs[0].contacts[i].f).norm(), few * force);
  }
}

// Nodes of both sides are more constraints than displacements: forces at the nodes stay determinate.
TEST(Unilateral, equilibrium_with_two_passes_lets_no_node_through) {
  const double force = 300;
  const model::Snapshot found = equilibrium(press(force, kUnilateral, true));
  EXPECT_NEAR(found.pairs[0].force.x(), force, 1e-6 * force);
  EXPECT_LT(found.pairs[0].penetration, 1e-5);
  const model::Snapshot one_pass = equilibrium(press(force, kUnilateral, false));
  std::printf("largest pressure %.4g Pa in two passes, %.4g Pa in one\n", found.pairs[0].total.pressure,
              one_pass.pairs[0].total.pressure);
  EXPECT_NEAR(found.pairs[0].total.pressure, one_pass.pairs[0].total.pressure,
              0.25 * one_pass.pairs[0].total.pressure);
  for (const auto& contact : found.pairs[0].contacts) EXPECT_GT(contact.f.norm(), 0);
}

// By how much of the forces another contact detection, in the same state, changes them.
double change_by_another_look(System& system, double time, const Eigen::VectorXd& U) {
  const Eigen::VectorXd V = Eigen::VectorXd::Zero(U.size());
  const auto forces = [&](const Eigen::VectorXd& velocity) {
    Eigen::Matrix3Xd f = Eigen::Matrix3Xd::Zero(3, system.bodies()[1].node_area.size());
    const NodalForces& found = system.contacts(time, U, velocity).force[1];
    for (std::size_t i = 0; i < found.node.size(); ++i)
      f.col(found.node[i]) = found.f_B.col(static_cast<Eigen::Index>(i));
    return f;
  };
  // Forces without friction do not depend on velocities, of which others have them looked for anew.
  const Eigen::Matrix3Xd found = forces(V), again = forces(V.array() + 1);
  return (again - found).norm() / again.norm();
}

// Blocks with smooth surfaces, the second of which slides along the first.
Blocks sliding_blocks(bool two_pass) {
  Blocks b = blocks(kUnilateral, two_pass, 0);
  b.setups[1].joint.type = body::JointType::prismatic;
  b.setups[1].joint.axis = {0, 1, 0};
  b.pair.settings.surface = contact::ContactSurface::smooth;
  return b;
}

// The blocks, bent, come together and slide along each other, in steps that change the forces by small and
// by large shares: where no second look was made, it would have found the same forces. On facets nodes pass
// to and fro between two faces in some states, whose forces have no other look's.
TEST(Unilateral, forces_of_a_stage_are_those_of_another_look) {
  constexpr double kFound = 1e-8;  // of the forces
  for (bool two_pass : {false, true}) {
    const Blocks b = sliding_blocks(two_pass);
    System system(b.setups, {b.pair});
    Eigen::VectorXd U = system.initial_position();
    std::srand(1);
    U = 0.01 * Eigen::VectorXd::Random(U.size());
    double largest = 0, time = 0;
    for (double step = 1e-6; step < 0.02; step *= 1.1) {
      U[0] = 0.05 + time / 2;  // m, of the ram
      U[U.size() / 2] = time;  // m, of the wall
      largest = std::max(largest, change_by_another_look(system, time, U));
      time += step;
    }
    std::printf("%s: %.2g\n", two_pass ? "two passes" : "one pass", largest);
    EXPECT_GT(largest, 0) << "no other look was made";
    EXPECT_LT(largest, kFound);
  }
}

// States that are read have forces within 1e-5 of those of states that are solved for, which are found
// nevertheless when they are asked for afterwards.
TEST(Unilateral, observed_forces_are_near_those_in_balance) {
  constexpr double kObserved = 1e-5, kFound = 1e-8;  // of the forces
  const Blocks b = sliding_blocks(false);
  System system(b.setups, {b.pair});
  Eigen::VectorXd U = system.initial_position();
  std::srand(1);
  U = 0.01 * Eigen::VectorXd::Random(U.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(U.size());
  double largest = 0, time = 0;
  for (double step = 1e-6; step < 0.02; step *= 1.1) {
    U[0] = 0.05 + time / 2;  // m, of the ram
    U[U.size() / 2] = time;  // m, of the wall
    const NodalForces observed = system.observed_contacts({time, U, zero, zero}).force[1];
    const NodalForces found = system.contacts(time, U, zero).force[1];
    if (observed.node == found.node && found.f_B.norm() > 0)
      largest = std::max(largest, (observed.f_B - found.f_B).norm() / found.f_B.norm());
    EXPECT_EQ(&system.observed_contacts({time, U, zero, zero}), &system.contacts(time, U, zero));
    EXPECT_LT(change_by_another_look(system, time, U), kFound);
    time += step;
  }
  std::printf("observed forces within %.2g\n", largest);
  EXPECT_GT(largest, kFound) << "all were found as exactly";
  EXPECT_LT(largest, kObserved);
}

// The ram is driven against the wall, which is driven aside. They touch, and stick, from the start.
System press_and_rub(double aside, double stiffness, contact::SlavePoints points,
                     const contact::FrictionSettings& friction) {
  constexpr double kApproach = 2e-3, kGap = 1e-4, kOverlap = 1e-5;  // m
  Blocks b = blocks(stiffness, points == contact::SlavePoints::nodes, kGap);
  b.pair.settings.points = points;
  b.setups[0].translation.drive = speed_drive(0, kApproach);
  b.setups[1].joint.type = body::JointType::prismatic;
  b.setups[1].joint.axis = {0, 1, 0};
  b.setups[1].translation.drive = speed_drive(0, aside);
  b.pair.settings.offset = -kGap - kOverlap;
  b.pair.settings.friction = friction;
  for (BodySetup& setup : b.setups) scale_by_load_factor(setup, 1);
  return System(b.setups, {b.pair});
}

struct Rubbed {
  Vector3d force;  // N
  double taken;    // J
};

Rubbed rubbed(double aside, double stiffness, contact::SlavePoints points) {
  const contact::FrictionSettings friction{.mu = 0.3, .mu_static = 0.32, .law = contact::FrictionLaw::stick};
  const model::Snapshot found = equilibrium(press_and_rub(aside, stiffness, points, friction));
  return {found.pairs[0].force, found.energy.dissipated};
}

// With twice and once the stiffness: to first order the limit.
Rubbed limit_of_springs(double aside, double stiffness, contact::SlavePoints points) {
  const Rubbed a = rubbed(aside, stiffness, points), b = rubbed(aside, stiffness / 2, points);
  return {2 * a.force - b.force, 2 * a.taken - b.taken};
}

void expect_limit(double aside, contact::SlavePoints points, double stiffness, double tolerance) {
  const Rubbed found = rubbed(aside, kUnilateral, points), limit = limit_of_springs(aside, stiffness, points);
  std::printf("%g m aside, %s: force %.5g %.5g N, limit of springs %.5g %.5g N, taken %.4g, %.4g J\n", aside,
              points == contact::SlavePoints::nodes ? "nodes" : "faces", found.force.x(), found.force.y(),
              limit.force.x(), limit.force.y(), found.taken, limit.taken);
  EXPECT_LT((found.force - limit.force).norm(), tolerance * found.force.norm());
  EXPECT_NEAR(found.taken, limit.taken, 2 * tolerance * limit.taken + 1e-5);
}

// At the first, all or nearly all nodes stick; at the others, some or all have slid in the end. Over
// faces, whose tangent is not exact, no equilibrium is found with stiffer springs, of which a percent is
// left.
TEST(Unilateral, equilibrium_with_friction_that_sticks_is_the_limit_of_stiff_springs) {
  for (double aside : {4e-4, -3e-3, 5e-3}) {
    expect_limit(aside, contact::SlavePoints::nodes, 1e7, 2e-4);
    expect_limit(aside, contact::SlavePoints::faces, 3e5, 0.015);
  }
}

// The ram is pressed against the wall while that is driven aside: what friction takes through the static
// responses is not in the slip.
TEST(Unilateral, energy_of_rubbing_is_kept_account_of) {
  constexpr double kForce = 30, kSpeed = 0.1, kRise = 0.05, kEnd = 0.12;  // N, m/s, s, s
  Blocks b = blocks(kUnilateral, false, 1e-4);
  b.setups[0].translation.load = ramp_signal(kForce, kRise);
  b.setups[1].joint.type = body::JointType::prismatic;
  b.setups[1].joint.axis = {0, 1, 0};
  b.setups[1].translation.drive = speed_drive(0, kSpeed);
  b.pair.settings.friction = {.mu = 0.3, .v_0 = 1e-3};
  System system(b.setups, {b.pair});
  double dissipated = 0;
  const RunSummary summary =
      simulate(system, {.dt = 2e-4, .end_time = kEnd, .rho_inf = 1},
               [&](const model::Snapshot& snapshot) { dissipated = snapshot.energy.dissipated; });
  std::printf("taken %.4g J, balance %.3g J off\n", dissipated, summary.largest_imbalance);
  EXPECT_LT(summary.largest_imbalance, 1e-3 * dissipated);
}

// An elastic bar hits another one at rest, or a wall (St. Venant): contact lasts 2 L / c of the shorter bar,
// the force is rho c v A / 2, or rho c v A. They move along x alone, with frames at their far ends.
constexpr double kLength = 0.2, kWidth = 0.02, kSpeed = 100;  // m, m, m/s
constexpr double kWaveSpeed = 5000;                           // m/s, of E = 200 GPa, rho = 8000 kg/m^3
constexpr double kContactTime = 2 * kLength / kWaveSpeed;     // s
constexpr double kForce = 8000. * kWaveSpeed * kSpeed * kWidth * kWidth;  // N, on a wall

struct Collision {
  const char* name;
  double other_length;  // m, 0: a wall
  int cells;            // of the first bar, as long as those of the other
  double kept;          // share of the modes
  double tolerance;     // of time and force, for what the mesh and missing modes take
  bool full = false;    // unreduced, without residual flexibility
};

BodySetup bar(const std::string& name, const Collision& c, double length, double x_held, double x,
              double speed) {
  const int cells = static_cast<int>(std::lround(c.cells * length / kLength));
  test::BoxSpec spec{.size = {length, kWidth, kWidth}, .cells = {cells, 1, 1}, .material = {2e11, 0, 8000}};
  spec.held = [=](const Vector3d& X, int direction) {
    return direction != 0 || std::abs(X.x() - x_held) < 1e-9;
  };
  const int n_modes = static_cast<int>(c.kept * cells);
  BodySetup setup{
      .name = name,
      .body = std::make_shared<model::ElasticBody>(c.full ? test::make_box(spec, model::Basis::full)
                                                          : test::make_flexible_box(spec, n_modes))};
  setup.joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}, .r_WB0 = {x, 0, 0}};
  setup.translation.s_dot_0 = speed;
  return setup;
}

BodySetup wall(double x) {
  return {.name = "b",
          .body = std::make_shared<model::ElasticBody>(
              test::make_rigid_box({.corner = {0, -kWidth, -kWidth},
                                    .size = {kWidth, 3 * kWidth, 3 * kWidth},
                                    .material = {2e11, 0, 8000}})),
          .joint = {.r_WB0 = {x, 0, 0}}};
}

struct History {
  std::vector<double> time, force;  // s, N
  double imbalance, taken;          // of the energy at the start
};

History collide(const Collision& c) {
  constexpr double kGap = 1e-4;  // m
  const BodySetup first = bar("a", c, kLength, 0, 0, kSpeed),
                  second = c.other_length > 0 ? bar("b", c, c.other_length, c.other_length, kLength + kGap, 0)
                                              : wall(kLength + kGap);
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.law = contact::ContactLaw::unilateral;
  System system({first, second}, {pair});
  History history;
  double taken = 0;
  const RunSummary summary = simulate(system, {.dt = 1e-5 / c.cells, .end_time = 1e-4, .rho_inf = 0.8},
                                      [&](const model::Snapshot& snapshot) {
                                        history.time.push_back(snapshot.time);
                                        history.force.push_back(snapshot.pairs[0].force.x());
                                        taken = snapshot.energy.dissipated;
                                      });
  history.imbalance = summary.largest_imbalance / summary.initial_energy;
  history.taken = taken / summary.initial_energy;
  return history;
}

// When the force passes a value for the first time, or from the end on for the last time.
double passes(const History& h, double force, bool last) {
  const auto n = h.force.size();
  for (std::size_t k = 1; k < n; ++k) {
    const std::size_t i = last ? n - k : k;
    const double a = h.force[i - 1], b = h.force[i];
    if ((a < force) != (b < force))
      return h.time[i - 1] + (force - a) / (b - a) * (h.time[i] - h.time[i - 1]);
  }
  return 0;
}

class Bars : public testing::TestWithParam<Collision> {};

// Time between the passages of half the force; the mean over the middle 80 %.
TEST_P(Bars, touch_for_two_passages_of_the_wave_with_the_force_of_its_impedance) {
  const Collision& c = GetParam();
  const History h = collide(c);
  const double expected = c.other_length > 0 ? kForce / 2 : kForce;
  const double start = passes(h, expected / 2, false), time = passes(h, expected / 2, true) - start;
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < h.time.size(); ++i)
    if (std::abs(h.time[i] - start - time / 2) < 0.4 * time) sum += h.force[i], ++n;
  std::printf(
      "%s, %d cells, %s, %g of the modes: contact time %+.3f %%, mean force %+.3f %%, balance %.1e, taken "
      "%.4f %%\n",
      c.name, c.cells, c.full ? "full" : "residual flexibility", c.kept, 100 * (time / kContactTime - 1),
      100 * (sum / n / expected - 1), h.imbalance, 100 * h.taken);
  const std::string of = std::string(c.name) + ", " + std::to_string(c.cells) + " cells, " +
                         (c.full       ? "full basis"
                          : c.kept < 1 ? "some modes"
                                       : "all modes");
  test::figure({of, "contact time", "%"}, time / kContactTime - 1, c.tolerance);
  test::figure({of, "force", "%"}, sum / n / expected - 1, c.tolerance);
  EXPECT_LT(h.imbalance, c.full ? 3e-4 : 1e-4);
  // An impact takes the kinetic energy of each node that it stops: that of about a third of a cell.
  const double lost = c.full ? (c.other_length > 0 ? 0.5 : 1) / (3. * c.cells) : 0;
  EXPECT_NEAR(h.taken, lost, 0.1 * lost + 1e-12);
}

INSTANTIATE_TEST_SUITE_P(StVenant, Bars,
                         testing::Values(Collision{"two equal bars", kLength, 200, 1, 0.005},
                                         Collision{"two equal bars", kLength, 100, 0.5, 0.02},
                                         Collision{"bars of lengths 1 and 2", 2 * kLength, 200, 1, 0.005},
                                         Collision{"bar on a wall", 0, 200, 1, 0.005},
                                         Collision{"two equal bars", kLength, 200, 1, 0.01, true},
                                         Collision{"bars of lengths 1 and 2", 2 * kLength, 100, 1, 0.01,
                                                   true},
                                         Collision{"bar on a wall", 0, 200, 1, 0.01, true},
                                         Collision{"bar on a wall", 0, 100, 1, 0.015, true}));

}  // namespace
}  // namespace elastogear::unilateral_contact_test
