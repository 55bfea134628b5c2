// Bodies on axes under loads, weight, friction and prescribed motion, against closed solutions.
#include <gtest/gtest.h>

#include <cmath>

#include "box_body.h"
#include "elastogear/base/error.h"
#include "elastogear/body/rigid.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::joint_motion_test {
using namespace dynamics;
using body::JointType;
using Eigen::Vector3d;

namespace {

constexpr double kMass = 2;          // kg
constexpr double kInertia = 0.4;     // kg m^2, about the centre of mass, all axes
constexpr double kTimeError = 1e-5;  // relative, of the time integration at the steps used
constexpr double kLedger = 1e-6;     // relative, of the energy balance

std::shared_ptr<const model::ElasticBody> block(const Vector3d& c = {0, 0, 0}) {
  return std::make_shared<model::ElasticBody>(
      body::rigid_body(kMass, c, kInertia * Eigen::Matrix3d::Identity()));
}

BodySetup sliding(const Axis& translation) {
  return {.name = "block",
          .body = block(),
          .joint = {.type = JointType::prismatic, .axis = {1, 2, 2}},
          .translation = translation};
}

model::Snapshot run(BodySetup setup, double dt, double end, const Vector3d& gravity = {0, 0, 0}) {
  System system({std::move(setup)}, {}, {.gravity = gravity});
  model::Snapshot last;
  simulate(system, {.dt = dt, .end_time = end}, [&](const model::Snapshot& x) { last = x; });
  return last;
}

void expect_near(double found, double exact, double relative) {
  EXPECT_NEAR(found, exact, relative * std::abs(exact));
}

TEST(Prismatic, slides_by_F_t3_over_6_m_T_under_a_ramp) {
  const model::Snapshot x = run(sliding({.load = ramp_signal(6, 2)}), 1e-3, 2);
  expect_near(x.bodies[0].s[0], 6 * 8 / (6 * kMass * 2), kTimeError);
  EXPECT_LT((x.bodies[0].r_WB - x.bodies[0].s[0] * Vector3d(1, 2, 2) / 3).norm(), 1e-12);
  EXPECT_NEAR(x.energy.balance, 0, kLedger * x.energy.work);
}

TEST(Prismatic, viscous_damping_slows_exponentially) {
  const model::Snapshot x = run(sliding({.s_dot_0 = 3, .damping = 4}), 1e-3, 1);
  expect_near(x.bodies[0].s_dot[0], 3 * std::exp(-4 / kMass), kTimeError);
  EXPECT_NEAR(x.energy.balance, 0, kLedger * x.energy.dissipated);
}

// A spring and a damper that a program computes.
TEST(Prismatic, swings_and_fades_under_a_computed_force) {
  constexpr double kSpring = 50, kDamper = 2;
  const double decay = kDamper / (2 * kMass), omega = std::sqrt(kSpring / kMass - decay * decay);
  const Axis axis{.s_0 = 0.1, .law = [](double, double s, double v) { return -kSpring * s - kDamper * v; }};
  const model::Snapshot x = run(sliding(axis), 2e-4, 1);
  const double exact =
      0.1 * std::exp(-decay) * (std::cos(omega) + decay / omega * std::sin(omega));  // after 1 s
  expect_near(x.bodies[0].s[0], exact, kTimeError);
  EXPECT_NEAR(x.energy.balance, 0, kLedger * kSpring * 0.01);
}

TEST(Prismatic, friction_stops_after_m_v2_over_2_F) {
  const Axis axis{.s_dot_0 = 3, .friction = 6, .friction_rate = 0.003};
  const model::Snapshot x = run(sliding(axis), 1e-3, 1.5);   // it stops after 1 s
  expect_near(x.bodies[0].s[0], kMass * 9 / (2 * 6), 1e-2);  // creeps by the friction rate
  EXPECT_LT(std::abs(x.bodies[0].s_dot[0]), axis.friction_rate);
}

TEST(Prismatic, falls_along_its_axis_with_its_share_of_gravity) {
  const Vector3d g(0, 0, -9);
  const model::Snapshot x = run(sliding({}), 1e-2, 2, g);
  expect_near(x.bodies[0].s[0], g.dot(Vector3d(1, 2, 2)) / 3 * 2, kTimeError);
}

TEST(Revolute, pendulum_swings_with_the_period_of_the_elliptic_integral) {
  constexpr double kArm = 0.5, kAngle = 2, kGravity = 9.81;
  const double omega = std::sqrt(kMass * kGravity * kArm / (kInertia + kMass * kArm * kArm));
  const double period = 4 * std::comp_ellint_1(std::sin(kAngle / 2)) / omega;
  // The centre of mass is in the BRF's origin; the axis passes through a point above it.
  BodySetup setup{.name = "pendulum",
                  .body = block(),
                  .joint = {.type = JointType::revolute, .axis = {1, 0, 0}, .point = {0, 0, kArm}},
                  .rotation = {.s_0 = kAngle}};
  const model::Snapshot x = run(setup, period / 4000, period, {0, 0, -kGravity});
  expect_near(x.bodies[0].s[0], kAngle, kTimeError);
  EXPECT_NEAR(x.bodies[0].s_dot[0], 0, 1e-3);
  EXPECT_NEAR(x.energy.balance, 0, kLedger * kMass * kGravity * kArm);
}

TEST(Cylindrical, turns_as_prescribed_and_slides_under_its_load) {
  BodySetup setup{.name = "screw",
                  .body = block({0.3, 0, 0}),
                  .joint = {.type = JointType::cylindrical},
                  .rotation = {.drive = spin_up_drive(0.1, 5, 1)},
                  .translation = {.load = constant_signal(4)}};
  const model::Snapshot x = run(setup, 1e-3, 0.6);
  const Prescribed p = at(setup.rotation.drive.value(), 0.6);
  EXPECT_EQ(x.bodies[0].s[0], p.s);
  EXPECT_EQ(x.bodies[0].s_dot[0], p.s_dot);
  expect_near(x.bodies[0].s[1], 4 * 0.36 / (2 * kMass), kTimeError);
  expect_near(x.bodies[0].joint_force[0], (kInertia + kMass * 0.09) * p.s_ddot, kTimeError);
  EXPECT_EQ(x.bodies[0].joint_force[1], 4);
  EXPECT_NEAR(x.energy.balance, 0, kTimeError * x.energy.work);  // the drive's work: trapezoidal rule
}

TEST(Revolute, drive_of_an_elastic_body_pays_for_all_its_energy) {
  const test::BoxSpec box{.corner = {0.1, -0.5, -0.5},
                          .size = {2, 1, 1},
                          .cells = {3, 1, 1},
                          .material = {300, 0.3, 1},
                          .held = [](const auto& X, int) { return X.x() < 0.2; }};
  const auto body = std::make_shared<model::ElasticBody>(test::make_box(box, model::Basis::modal, 10));
  const BodySetup setup{.name = "beam",
                        .body = body,
                        .joint = {.type = JointType::revolute},
                        .rotation = {.drive = spin_up_drive(0, 2, 1)}};
  const model::Snapshot x = run(setup, 1e-3, 1.5);
  EXPECT_GT(x.energy.elastic, 1e-3 * x.energy.kinetic);
  EXPECT_NEAR(x.energy.balance, 0, kTimeError * x.energy.work);
}

TEST(System, refuses_motions_that_the_joint_does_not_have) {
  const auto refuses = [](const BodySetup& setup) { EXPECT_THROW(System({setup}, {}), Error); };
  BodySetup setup = sliding({});
  setup.rotation.load = constant_signal(1);
  refuses(setup);
  setup = sliding({});
  setup.omega0 = {0, 0, 1};
  refuses(setup);
  setup = sliding({});
  setup.joint.axis.setZero();
  refuses(setup);
  setup = sliding({.load = constant_signal(1), .drive = speed_drive(0, 1)});
  refuses(setup);
  setup = sliding({});
  setup.joint.type = JointType::free;
  EXPECT_NO_THROW(System({setup}, {}));
  setup.translation.s_dot_0 = 1;
  refuses(setup);
}

TEST(System, refuses_bodies_without_inertia_against_a_motion) {
  auto body = std::make_shared<model::ElasticBody>(*block());
  body->inertia.J.setZero();
  BodySetup setup{.name = "point", .body = body, .joint = {.type = JointType::revolute}};
  EXPECT_THROW(System({setup}, {}), Error);
  setup.joint.type = JointType::prismatic;
  EXPECT_NO_THROW(System({setup}, {}));
  EXPECT_THROW(body::rigid_body(0, {0, 0, 0}, Eigen::Matrix3d::Identity()), Error);
  EXPECT_THROW(body::rigid_body(1, {0, 0, 0}, Vector3d(1, 1, 3).asDiagonal()), Error);
}

TEST(Simulate, refuses_tables_that_end_before_the_run) {
  EXPECT_THROW(run(sliding({.load = table_signal({0, 1}, {0, 1})}), 0.1, 2), Error);
}

}  // namespace
}  // namespace elastogear::joint_motion_test
