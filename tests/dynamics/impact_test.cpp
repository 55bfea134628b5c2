// Longitudinal impact of elastic bars (St. Venant): E = 200 GPa, rho = 8000 kg/m^3, so that c = 5000 m/s.
// Bars are lines of hexahedra with nu = 0 that may only move along x; they fly freely, so that their rigid
// motion is part of q.
#include <gtest/gtest.h>

#include "box_body.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::impact_test {
using namespace dynamics;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kLength = 0.2, kWidth = 0.02, kSpeed = 100;              // m, m, m/s
const model::Material kSteel{2e11, 0, 8000};                              // E, nu, rho
constexpr double kWaveSpeed = 5000;                                       // m/s, sqrt(E / rho)
constexpr double kContactTime = 2 * kLength / kWaveSpeed;                 // s
constexpr double kForce = 8000. * kWaveSpeed * kSpeed * kWidth * kWidth;  // N, rho c v A
constexpr double kGap = 2e-4;                                             // m
constexpr double kDiscretisation = 0.02;  // of times and forces, 100 cells a bar; falls with their size

bool only_along_x(const Vector3d&, int direction) { return direction != 0; }

std::shared_ptr<const model::ElasticBody> bar(model::Basis basis, int cells = 100) {
  const test::BoxSpec spec{.corner = {0, 0, 0},
                           .size = {kLength, kWidth, kWidth},
                           .cells = {cells, 1, 1},
                           .material = kSteel,
                           .held = only_along_x};
  return std::make_shared<model::ElasticBody>(test::make_box(spec, basis));
}

std::shared_ptr<const model::ElasticBody> wall() {
  const test::BoxSpec spec{
      .corner = {0, -kWidth, -kWidth}, .size = {0.004, 3 * kWidth, 3 * kWidth}, .material = kSteel};
  return std::make_shared<model::ElasticBody>(test::make_rigid_box(spec));
}

BodySetup flying(const std::string& name, const std::shared_ptr<const model::ElasticBody>& body, double x,
                 double speed) {
  BodySetup setup{.name = name, .body = body};
  setup.joint.r_WB0.x() = x;
  setup.q_dot0 = test::uniform_velocity(*body, {speed, 0, 0});
  return setup;
}

// Speed of the centre of mass: momentum C_l' q' / m.
double mean_speed(const model::ElasticBody& body, const model::BodyState& state) {
  return body.inertia.C_l.col(0).dot(state.q_dot) / body.inertia.m;
}

struct Outcome {
  RunSummary summary;
  std::vector<double> time, force;  // s, N on body b along x
  model::Snapshot last;

  double contact_time() const {
    double first = INFINITY, last_time = 0;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (force[i] != 0) {
        first = std::min(first, time[i]);
        last_time = time[i];
      }
    return last_time - first;
  }
  double mean_force(double from, double to) const {
    double sum = 0;
    int n = 0;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (time[i] >= from && time[i] <= to) {
        sum += force[i];
        ++n;
      }
    return sum / n;
  }
};

Outcome run(System system, double rho_inf = 1) {
  Outcome outcome;
  const TimeSettings settings{.dt = 2e-7, .end_time = 1.1e-4, .rho_inf = rho_inf};
  outcome.summary = simulate(system, settings, [&](const model::Snapshot& snapshot) {
    outcome.time.push_back(snapshot.time);
    outcome.force.push_back(snapshot.pairs[0].force.x());
    outcome.last = snapshot;
  });
  return outcome;
}

// The penalty's own compliance lengthens the contact; as stiff as half a cell it does so by less than 1 %.
System bar_on_wall(model::Basis basis) {
  const auto body = bar(basis);
  PairSetup pair{"bar:wall", {0, 1}, {}};
  pair.settings.stiffness = 2 * body->surface.c_f[0];
  return System({flying("bar", body, 0, kSpeed), flying("wall", wall(), kLength + kGap, 0)}, {pair});
}

System two_bars(model::Basis basis) {
  const auto body = bar(basis);
  return System({flying("a", body, 0, kSpeed), flying("b", body, kLength + kGap, 0)}, {{"a:b", {0, 1}, {}}});
}

TEST(BarOnWall, rebounds_after_two_passages_of_the_wave_at_the_force_rho_c_v_A) {
  const Outcome outcome = run(bar_on_wall(model::Basis::modal));
  const double touch = kGap / kSpeed;
  EXPECT_NEAR(outcome.contact_time(), kContactTime, kDiscretisation * kContactTime);
  EXPECT_NEAR(outcome.mean_force(touch + 0.1 * kContactTime, touch + 0.9 * kContactTime), kForce,
              kDiscretisation * kForce);
  const double speed = mean_speed(*bar(model::Basis::modal), outcome.last.bodies[0]);
  EXPECT_LT(speed, 0);
  EXPECT_LE(-speed, 1.01 * kSpeed);
  EXPECT_LT(outcome.summary.largest_imbalance, 0.01 * outcome.summary.initial_energy);
}

TEST(TwoBars, exchange_their_velocities) {
  const auto body = bar(model::Basis::modal);
  const Outcome outcome = run(two_bars(model::Basis::modal));
  EXPECT_NEAR(outcome.contact_time(), kContactTime, kDiscretisation * kContactTime);
  EXPECT_NEAR(mean_speed(*body, outcome.last.bodies[0]), 0, kDiscretisation * kSpeed);
  EXPECT_NEAR(mean_speed(*body, outcome.last.bodies[1]), kSpeed, kDiscretisation * kSpeed);
  EXPECT_LT(outcome.summary.largest_imbalance, 0.01 * outcome.summary.initial_energy);
}

TEST(TwoBars, full_basis_and_all_modes_give_the_same_impact) {
  constexpr double kNewtonTolerance = 1e-6;  // accumulated over the steps
  const Outcome modal = run(two_bars(model::Basis::modal)), full = run(two_bars(model::Basis::full));
  ASSERT_EQ(modal.force.size(), full.force.size());
  for (std::size_t i = 0; i < modal.force.size(); ++i)
    EXPECT_NEAR(modal.force[i], full.force[i], kNewtonTolerance * kForce);
  EXPECT_GT(full.summary.pair[0].peak_force, 0.5 * kForce);
}

}  // namespace
}  // namespace elastogear::impact_test
