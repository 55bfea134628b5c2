// Impact of bodies in motion without a penalty and without residual flexibility: rigid ones, and full bases.
#include <gtest/gtest.h>

#include <cstdio>

#include "../figures.h"
#include "box_body.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::impact_law_test {
using namespace dynamics;
using contact::FrictionLaw, contact::SlavePoints;
using Eigen::Vector3d;

namespace {

constexpr double kMass = 2000, kGap = 1e-3, kSpeed = 0.7, kStep = 1e-4;  // kg, m, m/s, s

std::shared_ptr<const model::ElasticBody> rigid_cube(const Vector3d& corner, double side) {
  return std::make_shared<model::ElasticBody>(test::make_rigid_box({.corner = corner,
                                                                    .size = Vector3d::Constant(side),
                                                                    .cells = {2, 2, 2},
                                                                    .material = {1e9, 0.3, kMass}}));
}

struct Wall {
  double restitution = 0;
  SlavePoints points = SlavePoints::nodes;
  contact::FrictionSettings friction = {};
  double force = 0;          // N, towards the wall
  double aside = 0;          // m/s
  double approach = kSpeed;  // m/s
  double gap = kGap;         // m
};

// A cube of 1 m before a wall normal to x, which may slide along it where it is rubbed.
System cube_at(const Wall& wall) {
  BodySetup cube{.name = "cube", .body = rigid_cube({-1, -0.5, -0.5}, 1)};
  cube.joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}};
  cube.translation.load = constant_signal(wall.force);
  cube.translation.s_dot_0 = wall.approach;
  BodySetup other{
      .name = "wall", .body = rigid_cube({0, -1.6, -1.6}, 3), .joint = {.r_WB0 = {wall.gap, 0, 0}}};
  if (wall.friction.mu > 0) {
    other.joint.type = body::JointType::prismatic;
    other.joint.axis = {0, 1, 0};
    other.translation.s_dot_0 = wall.aside;
  }
  PairSetup pair{"cube:wall", {0, 1}, {}};
  pair.settings.law = contact::ContactLaw::unilateral;
  pair.settings.points = wall.points;
  pair.settings.restitution = wall.restitution;
  pair.settings.friction = wall.friction;
  pair.settings.extension = 0;
  return System({cube, other}, {pair});
}

struct Motion {
  std::vector<model::Snapshot> states;
  RunSummary summary;

  const model::Snapshot& last() const { return states.back(); }
  // N s
  double impulse() const {
    double sum = 0;
    for (std::size_t i = 1; i < states.size(); ++i)
      sum += states[i].pairs[0].force.x() * (states[i].time - states[i - 1].time);
    return sum;
  }
};

Motion move(System system, const TimeSettings& settings) {
  Motion motion;
  motion.summary =
      simulate(system, settings, [&](const model::Snapshot& state) { motion.states.push_back(state); });
  return motion;
}

class Rebound : public testing::TestWithParam<std::tuple<double, SlavePoints, double>> {};

TEST_P(Rebound, has_the_speed_of_its_coefficient_of_restitution) {
  const auto [e, points, rho_inf] = GetParam();
  const Motion motion = move(cube_at({.restitution = e, .points = points}),
                             {.dt = kStep, .end_time = 4e-3, .rho_inf = rho_inf});
  const double energy = 0.5 * kMass * kSpeed * kSpeed;
  std::printf("e %g: rate %.10g m/s, impulse %.10g N s, taken %.8g J, balance %.2g J\n", e,
              motion.last().bodies[0].s_dot[0], motion.impulse(), motion.last().energy.dissipated,
              motion.last().energy.balance);
  test::figure({"impact law, rigid cube", "speed of rebound"}, motion.last().bodies[0].s_dot[0] / kSpeed + e,
               1e-4);
  EXPECT_NEAR(motion.impulse(), kMass * kSpeed * (1 + e), 1e-4 * kMass * kSpeed);
  EXPECT_NEAR(motion.last().energy.dissipated, (1 - e * e) * energy, 2e-4 * energy);
  EXPECT_LT(motion.summary.largest_imbalance, 2e-4 * energy);
  EXPECT_EQ(motion.summary.rejected_steps, 0);
}

INSTANTIATE_TEST_SUITE_P(Cube, Rebound,
                         testing::Combine(testing::Values(0., 0.6, 1.),
                                          testing::Values(SlavePoints::nodes, SlavePoints::minima,
                                                          SlavePoints::faces),
                                          testing::Values(1., 0.8)));

// Pressed against the wall from a distance it hits and stays, without chatter.
TEST(Impact, body_comes_to_rest) {
  constexpr double kForce = 1e4;  // N
  for (double rho_inf : {1., 0.8, 0.}) {
    const Motion motion =
        move(cube_at({.force = kForce, .approach = 0}), {.dt = kStep, .end_time = 0.3, .rho_inf = rho_inf});
    double off = 0, deepest = 0;
    for (const model::Snapshot& state : motion.states)
      if (state.time > 0.28) {
        off = std::max(off, std::abs(state.pairs[0].force.x() / kForce - 1));
        deepest = std::max(deepest, state.pairs[0].penetration);
      }
    std::printf("rho_inf %g: force off by %.2g, penetration %.2g m, rate %.2g, acceleration %.2g\n", rho_inf,
                off, deepest, motion.last().bodies[0].s_dot[0], motion.last().bodies[0].s_ddot[0]);
    EXPECT_LT(off, 1e-4);
    EXPECT_LT(deepest, 0.5 * kStep * std::sqrt(2 * kGap * kForce / kMass));
  }
}

// The wall slides past the cube that is pressed against it, until friction has stopped it.
TEST(Impact, friction_stops_what_slides) {
  constexpr double kForce = 2e5, kMu = 0.3, kAside = 0.2;  // N, -, m/s
  const double wall_mass = 27 * kMass, way = 0.5 * wall_mass * kAside * kAside / (kMu * kForce);
  for (FrictionLaw law : {FrictionLaw::regularised, FrictionLaw::stick})
    for (SlavePoints points : {SlavePoints::nodes, SlavePoints::faces}) {
      const contact::FrictionSettings friction{.mu = kMu, .law = law, .v_0 = 1e-4};
      const Motion motion = move(cube_at({.points = points,
                                          .friction = friction,
                                          .force = kForce,
                                          .aside = kAside,
                                          .approach = 0,
                                          .gap = 0}),
                                 {.dt = 4 * kStep, .end_time = 0.25, .rho_inf = 0.8});
      std::printf("way %.8g m of %.8g m, taken %.6g J, balance %.2g J\n", motion.last().bodies[1].s[0], way,
                  motion.last().energy.dissipated, motion.summary.largest_imbalance);
      EXPECT_NEAR(motion.last().bodies[1].s[0], way, 5e-3 * way);
      EXPECT_LT(motion.summary.largest_imbalance, 5e-3 * motion.last().energy.dissipated);
    }
}

}  // namespace
}  // namespace elastogear::impact_law_test
