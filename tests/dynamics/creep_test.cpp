// Residual flexibility of viscoelastic bodies: closed forms, and the same bodies in the full basis.

#include "elastogear/body/creep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "../contact/surfaces.h"
#include "../message_of.h"
#include "box_body.h"
#include "contact_bodies.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/dynamics/static.h"

namespace elastogear::creep_test {
using namespace dynamics;
using body::CreepLaw, body::CreepState;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

VectorXd numbers(const std::vector<double>& values) {
  return VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

struct Series {
  std::vector<double> g, tau;
};

body::RelaxationLaw law_of(const Series& series) {
  return {numbers(series.tau), numbers(series.g).transpose()};
}

// Creep compliance of one term over the time since loading, as a share of the instantaneous one.
double creep(double g, double tau, double t) {
  const double relaxed = 1 / (1 - g);
  return relaxed - (relaxed - 1) * std::exp(-t * (1 - g) / tau);
}

// Makes all of a body relax in the same ratio.
template <class Body>
Body relaxing(Body body, const Series& series) {
  body.relaxing = {{"", model::ModulusPart::both, numbers(series.g), numbers(series.tau), body.K_r}};
  if (!body.flexibility.empty()) body.flexibility.creep = 0;
  return body;
}

// ---- the law

TEST(CreepLaw, constant_force_creeps_by_the_creep_compliance) {
  for (double tau : {1e-7, 1.0, 1e5}) {
    const double g = 0.7;
    CreepLaw law(law_of({{g}, {tau}}));
    const Vector3d f(1, -2, 0.5);
    law.set_point(body::Moduli::relaxing, {0, 1});
    CreepState state = law.state(CreepState(), f);
    EXPECT_EQ(state.col(0), f);
    law.set_point(body::Moduli::relaxing, {tau / 200, 1});
    for (int step = 1; step <= 1000; ++step) {
      state = law.state(state, f);
      ASSERT_NEAR(state(0, 0), creep(g, tau, step * tau / 200), 1e-5) << step;
    }
  }
}

TEST(CreepLaw, moduli_that_do_not_depend_on_time) {
  CreepLaw law(law_of({{0.2, 0.3}, {1, 10}}));
  law.set_point(body::Moduli::long_term, {});
  EXPECT_NEAR(law.state(CreepState(), Vector3d::Ones())(0, 0), 2, 1e-14);
  EXPECT_NEAR(law.at_once(), law.long_term(), 1e-14);
  law.set_point(body::Moduli::instantaneous, {});
  EXPECT_EQ(law.state(CreepState(), Vector3d::Ones())(0, 0), 1);
}

// Work of the forces through their displacement = what springs keep and dashpots take, for any steps.
TEST(CreepLaw, energy_of_any_history_balances_to_roundoff) {
  CreepLaw law(law_of({{0.2, 0.3}, {0.1, 10}}));
  constexpr double kD = 3;  // m/N
  law.set_point(body::Moduli::relaxing, {0, 1});
  CreepState state = CreepState::Zero(3, law.n_columns());
  Vector3d f = Vector3d::Zero();
  double work = 0, loss = 0;
  for (int step = 0; step < 50; ++step) {
    law.set_point(body::Moduli::relaxing, {std::pow(10, -4 + step % 7), 1});
    const Vector3d next(std::sin(step), std::cos(3. * step), 0.1 * step);
    const CreepState to = law.state(state, next);
    work += 0.5 * (f + next).dot(kD * (to.col(0) - state.col(0)));
    const CreepState w = kD * state, w_to = kD * to;
    loss += law.loss({state, to}, {w, w_to});
    EXPECT_NEAR((next - (to.col(0) - 0.2 * to.col(1) - 0.3 * to.col(2))).norm(), 0, 1e-12);
    state = to;
    f = next;
  }
  const CreepState w = kD * state;
  EXPECT_NEAR(0.5 * law.twice_energy(state, w) + loss, work, 1e-11 * work);
  EXPECT_GT(loss, 0);
}

// Laws of which one has a negative share, as interpolation between states gives it.
TEST(CreepLaws, energy_of_several_laws_balances_to_roundoff) {
  body::CreepLaws laws({law_of({{0.2, 0.3}, {0.1, 10}}), law_of({{0.1, 0.15}, {0.1, 10}})});
  const Eigen::RowVector2d kD(2, -0.5);
  Vector3d f = Vector3d::Zero();
  CreepState force = CreepState::Zero(3, laws.n_columns()), displaced = force;
  double work = 0, loss = 0;
  for (int step = 1; step <= 50; ++step) {
    laws.set_point(body::Moduli::relaxing, {0.02 * step, 1});
    const Vector3d next(std::sin(0.7 * step), std::cos(0.2 * step), 0.1 * step);
    const CreepState to = laws.state(force, next),
                     w_to = laws.displaced_state(displaced, CreepState(next * kD));
    EXPECT_NEAR((w_to.middleCols<3>(3) + 0.5 * to.middleCols<3>(3)).norm(), 0, 1e-12);
    work += 0.5 * (f + next).dot(laws.sum(w_to) - laws.sum(displaced));
    loss += laws.loss({force, to}, {displaced, w_to});
    force = to;
    displaced = w_to;
    f = next;
  }
  EXPECT_NEAR(0.5 * laws.twice_energy(force, displaced) + loss, work, 1e-11 * std::abs(work));
}

// ---- a ball by E. H. Lee and J. R. M. Radok (J. Appl. Mech. 27 (1960) 438-444)

// A quarter of a half-space whose surface is a ball's, in few of its modes and with its static responses.
std::shared_ptr<const model::ElasticBody> ball(const test::HalfSpace& spec, double R, const Series& series) {
  constexpr int kModes = 4;
  const auto whole = test::half_space(spec, R);
  const auto& Phi = std::get<model::DenseRows>(whole->surface.Phi);
  const VectorXd stiffness = whole->K_r.diagonal();
  const Eigen::MatrixXd V = Phi;
  model::ElasticBody body = *whole;
  body.surface.Phi = model::DenseRows(Phi.leftCols(kModes));
  body.M_r = VectorXd::Ones(kModes).asDiagonal();
  body.K_r = VectorXd(stiffness.head(kModes)).asDiagonal();
  body.frequency = whole->frequency.head(kModes);
  body.inertia.C_l.setZero(kModes, 3);
  body.inertia.C_r.setZero(kModes, 3);
  body.inertia.S_1.setZero(9, kModes);
  test::set_flexibility(body, V * stiffness.cwiseInverse().asDiagonal() * V.transpose());
  return std::make_shared<model::ElasticBody>(relaxing(std::move(body), series));
}

struct Pressed {
  double time, depth, force;  // s, m, N
};

// By a rigid plane, which moves by `depth` where that is positive, else under the force.
std::vector<Pressed> pressed(const std::shared_ptr<const model::ElasticBody>& body, double half_width,
                             double depth, double force, double time) {
  BodySetup plane{.name = "plane"};
  const double l = 2 * half_width;
  plane.body = test::rigid_with(contact::test::flipped(contact::test::plane(1, 1, l, l)));
  plane.joint = {.type = body::JointType::prismatic, .axis = {0, 0, -1}};
  plane.joint.r_WB0 = {-l / 4, -l / 4, 0};
  if (depth > 0)
    plane.translation.drive = still_drive(0, depth);
  else
    plane.translation.load = constant_signal(force);
  if (depth <= 0) scale_by_load_factor(plane, kFar);
  PairSetup pair{"ball:plane", {0, 1}, {}};
  pair.settings.law = contact::ContactLaw::unilateral;
  pair.settings.surface = contact::ContactSurface::facets;
  pair.settings.depth = 0.01;
  System system({{.name = "ball", .body = body}, plane}, {pair});
  std::vector<Pressed> all;
  solve_static(system, {.steps = 8, .time_under_load = time}, [&](const model::Snapshot& s) {
    all.push_back({s.time, s.bodies[1].s[0], std::abs(s.pairs[0].force.z())});
  });
  return all;
}

TEST(Ball, pressed_in_relaxes_and_under_a_force_creeps_by_lee_and_radok) {
  const double g = 0.6, R = 2, E = 1.40625e7, nu = 0.25, depth = 0.005;
  const double a = std::sqrt(R * depth), h = a / 7;
  for (double tau : {1e-6, 1e4}) {
    const auto body = ball({E, nu, h, 11}, R, {{g}, {tau}});
    const auto held = pressed(body, 11 * h, depth, 0, 100 * tau);
    const double F = held.front().force;
    EXPECT_NEAR(4 * F, 4. / 3 * E / (1 - nu * nu) * std::sqrt(R) * std::pow(depth, 1.5), 0.01 * 4 * F);
    double worst = 0;
    for (const auto& [t, d, f] : held)
      worst = std::max(worst, std::abs(f / F - (1 - g * (1 - std::exp(-t / tau)))));
    const auto loaded = pressed(body, 11 * h, 0, 0.4 * F, 100 * tau);
    double worst_depth = 0;
    for (const auto& [t, d, f] : loaded)
      worst_depth =
          std::max(worst_depth, std::abs(d / loaded.front().depth - std::pow(creep(g, tau, t), 2. / 3)));
    std::printf("ball, time of %g s: force held %.1e, depth under a force %.1e off Lee and Radok\n", tau,
                worst, worst_depth);
    EXPECT_LT(worst, 1e-3);
    EXPECT_LT(worst_depth, 0.01);
    EXPECT_GT(loaded.back().depth, 1.8 * loaded.front().depth);
  }
}

// ---- blocks beside the full basis

enum class Kind { modal, flexible, full };

std::shared_ptr<model::ElasticBody> block(Kind kind, const Eigen::Vector3i& cells, double x_held,
                                          const Series& series) {
  constexpr int kModes = 6;
  const test::BoxSpec spec{
      .size = {1, 1, 1}, .cells = cells, .material = {1e4, 0.3, 1}, .held = [=](const Vector3d& X, int) {
        return std::abs(X.x() - x_held) < 1e-9;
      }};
  model::ElasticBody body = kind == Kind::flexible ? test::make_flexible_box(spec, kModes)
                            : kind == Kind::full   ? test::make_box(spec, model::Basis::full)
                                                   : test::make_box(spec, model::Basis::modal, kModes);
  return std::make_shared<model::ElasticBody>(series.g.empty() ? body : relaxing(body, series));
}

constexpr double kForce = 60;  // N

struct Motion {
  double force = 0, speed = 0;  // N, m/s
};

// A viscoelastic block on a slide meets an elastic one, beside it by a third of its width.
System blocks(Kind kind, const Series& series, const Motion& motion, bool at_rest) {
  std::vector<BodySetup> setups{{.name = "ram", .body = block(kind, {2, 3, 2}, 0, series)},
                                {.name = "wall", .body = block(kind, {2, 2, 2}, 1, {})}};
  setups[0].joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}};
  setups[0].translation.load = at_rest ? constant_signal(motion.force) : ramp_signal(motion.force, 0.3);
  setups[0].translation.s_dot_0 = motion.speed;
  setups[1].joint.r_WB0 = {1.001, 0.25, 0.1};
  PairSetup pair{"ram:wall", {0, 1}, {}};
  pair.settings.stiffness = motion.speed > 0 ? 5e3 : 1e5;
  pair.settings.depth = 0.05;
  pair.settings.two_pass = true;
  if (at_rest) scale_by_load_factor(setups[0], kFar);
  return System(setups, {pair});
}

struct Point {
  double time, s, force;
};

Point point(const model::Snapshot& s) { return {s.time, s.bodies[0].s[0], s.pairs[0].force.norm()}; }

std::vector<Point> under_load(Kind kind, const Series& series, double time) {
  System system = blocks(kind, series, {kForce, 0}, true);
  std::vector<Point> all;
  solve_static(system, {.steps = 4, .time_under_load = time},
               [&](const model::Snapshot& s) { all.push_back(point(s)); });
  return all;
}

double largest_difference(const std::vector<Point>& a, const std::vector<Point>& b, double Point::*what) {
  double most = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i].*what - b[i].*what));
    size = std::max(size, std::abs(b[i].*what));
  }
  return most / size;
}

TEST(Blocks, creep_at_rest_is_that_of_the_full_basis) {
  const Series series{{0.2, 0.3, 0.2}, {1e-3, 0.1, 10}};
  const auto full = under_load(Kind::full, series, 1e3), flexible = under_load(Kind::flexible, series, 1e3),
             modal = under_load(Kind::modal, series, 1e3);
  ASSERT_EQ(flexible.size(), full.size());
  const double off = largest_difference(flexible, full, &Point::s);
  std::printf("blocks at rest over eight decades: %.1e off the full basis, modes alone %.1e\n", off,
              largest_difference(modal, full, &Point::s));
  EXPECT_LT(off, 1e-5);
  EXPECT_GT(largest_difference(modal, full, &Point::s), 0.05);
  EXPECT_GT(full.back().s, 1.8 * full.front().s);
}

// Between both moduli that do not depend on time.
TEST(Blocks, begin_and_end_at_the_moduli_without_time) {
  const Series series{{0.5}, {1}};
  const auto found = under_load(Kind::flexible, series, 1e3);
  for (const auto& [moduli, s] :
       {std::pair{body::Moduli::instantaneous, found.front().s}, {body::Moduli::long_term, found.back().s}}) {
    System system = blocks(Kind::flexible, series, {kForce, 0}, true);
    SystemModel model = system.model();
    model.environment.moduli = moduli;
    System at(std::move(model));
    double last = 0;
    solve_static(at, {4}, [&](const model::Snapshot& x) { last = x.bodies[0].s[0]; });
    EXPECT_NEAR(last, s, 1e-6 * s);
  }
}

std::vector<model::Snapshot> impact(Kind kind, const Series& series, double end = 0.06) {
  System system = blocks(kind, series, {0, 0.5}, false);
  std::vector<model::Snapshot> history;
  simulate(system, {.dt = 2e-4, .end_time = end}, [&](const model::Snapshot& s) { history.push_back(s); });
  return history;
}

std::vector<Point> points(const std::vector<model::Snapshot>& history) {
  std::vector<Point> all;
  for (const model::Snapshot& s : history) all.push_back(point(s));
  return all;
}

TEST(Blocks, impact_is_that_of_the_full_basis_and_its_energy_balances) {
  const Series series{{0.3, 0.3}, {2e-3, 2e-2}};
  const auto flexible = impact(Kind::flexible, series);
  const auto full = points(impact(Kind::full, series));
  const double off = largest_difference(points(flexible), full, &Point::force),
               modal = largest_difference(points(impact(Kind::modal, series)), full, &Point::force);
  const model::Energies& last = flexible.back().energy;
  std::printf("impact: force %.1e off the full basis, modes alone %.1e; balance %.1e of what is lost\n", off,
              modal, std::abs(last.balance) / last.relaxation);
  EXPECT_LT(off, 0.6 * modal);
  EXPECT_GT(last.relaxation, 0);
  for (const model::Snapshot& s : flexible) EXPECT_LT(std::abs(s.energy.balance), 1e-4 * last.relaxation);
}

// g = 0, and times far beyond the run.
TEST(Blocks, that_do_not_relax_are_elastic) {
  const auto force_of = [](const Series& series) { return points(impact(Kind::flexible, series, 0.03)); };
  const auto elastic = force_of({});
  EXPECT_LT(largest_difference(force_of({{0}, {1}}), elastic, &Point::force), 1e-9);
  EXPECT_LT(largest_difference(force_of({{0.5}, {1e12}}), elastic, &Point::force), 1e-9);
}

// A run that is taken up from its state goes on to the bit.
TEST(Blocks, go_on_from_a_checkpoint_to_the_bit) {
  const Series series{{0.3, 0.3}, {2e-3, 2e-2}};
  const TimeSettings time{.dt = 2e-4, .end_time = 0.022};
  std::vector<double> kept;
  std::vector<model::Snapshot> whole, rest;
  System first = blocks(Kind::flexible, series, {0, 0.5}, false),
         second = blocks(Kind::flexible, series, {0, 0.5}, false);
  Checkpoints keep;
  keep.every = 0;
  keep.keep = [&](const std::vector<double>& state) {
    if (whole.size() == 80) kept = state;
  };
  simulate(
      first, time, [&](const model::Snapshot& s) { whole.push_back(s); }, {}, keep);
  ASSERT_FALSE(kept.empty());
  Checkpoints from;
  from.state = kept;
  simulate(
      second, time, [&](const model::Snapshot& s) { rest.push_back(s); }, {}, from);
  ASSERT_GT(rest.size(), 10u);
  EXPECT_EQ(rest.back().pairs[0].force, whole.back().pairs[0].force);
  EXPECT_EQ(rest.back().bodies[0].q, whole.back().bodies[0].q);
  EXPECT_EQ(rest.back().energy.relaxation, whole.back().energy.relaxation);
}

// What a body remembers begins another run: without a load it comes back, and keeps none of its energy.
TEST(Blocks, begin_with_what_they_remember) {
  const Series series{{0.5}, {1}};
  System loaded = blocks(Kind::flexible, series, {kForce, 0}, true);
  Point last{};
  solve_static(loaded, {.steps = 4, .time_under_load = 5},
               [&](const model::Snapshot& s) { last = point(s); });
  ASSERT_FALSE(loaded.relaxed_state(0).node.empty());
  const auto begun = [&](double force) {
    SystemModel from = blocks(Kind::flexible, series, {force, 0}, false).model();
    std::vector<BodySetup> setups;
    for (const SystemModel::Body& body : from.bodies) {
      BodySetup setup{.name = body.name, .body = body.eq.body, .joint = body.eq.joint};
      setup.relaxed0 = loaded.relaxed_state(setups.size());
      if (!body.axis.empty()) setup.translation = body.axis[0];
      setups.push_back(setup);
    }
    setups[0].translation.s_0 = last.s;
    setups[0].translation.load = constant_signal(force);
    std::vector<Point> all;
    System system(setups, from.pairs);
    simulate(system, {.dt = 0.05, .end_time = 10, .rho_inf = 0},
             [&](const model::Snapshot& s) { all.push_back(point(s)); });
    return all;
  };
  const auto on = begun(kForce);  // goes on to creep from where it was
  EXPECT_NEAR(on.front().force, kForce, 1e-3 * kForce);
  EXPECT_NEAR(on.back().s, under_load(Kind::flexible, series, 15).back().s, 1e-3 * last.s);
}

}  // namespace
}  // namespace elastogear::creep_test
