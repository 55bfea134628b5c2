// Hinged bodies without contact: rotation, its coupling with the deformation, and the energy ledger.
#include <gtest/gtest.h>

#include <cmath>

#include "box_body.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::hinge_test {
using namespace dynamics;
using body::InertiaLevel;
using Eigen::VectorXd;

namespace {

constexpr double kNewton = 1e-7;  // relative, accumulated over the steps
constexpr double kOrder = 0.1;    // of a measured order of convergence

test::BoxSpec soft_box() {
  return {.corner = {0.1, -0.5, -0.5},
          .size = {2, 1, 1},
          .cells = {3, 1, 1},
          .material = {100, 0.3, 1},
          .held = [](const auto& X, int) { return X.x() < 0.2; }};
}

body::Joint hinge() { return {.type = body::JointType::revolute}; }

model::Snapshot last_state(System system, double dt, double end_time, RunSummary* summary = nullptr) {
  model::Snapshot last;
  const auto result = simulate(system, {.dt = dt, .end_time = end_time, .output_every = 1 << 20},
                               [&](const model::Snapshot& snapshot) { last = snapshot; });
  if (summary) *summary = result;
  return last;
}

System spinning_box(InertiaLevel level, double alpha = 0) {
  auto body = std::make_shared<model::ElasticBody>(test::make_box(soft_box(), model::Basis::modal, 10));
  body->alpha = alpha;
  return System({{.name = "box", .body = body, .joint = hinge(), .rotation = {.s_dot_0 = 2}}}, {}, {level});
}

// A point mass m on a radial spring k at radius R, on a massless arm about z, with a hub of inertia J_hub.
constexpr double kMass = 2, kRadius = 3, kSpring = 1000, kHub = 50;

System radial_spring(InertiaLevel level) {
  auto body = std::make_shared<model::ElasticBody>();
  model::Inertia& inertia = body->inertia;
  inertia.m = kMass;
  inertia.c = {kRadius, 0, 0};
  inertia.J.diagonal() << 1, kMass * kRadius * kRadius, kHub + kMass * kRadius * kRadius;
  inertia.C_l = Eigen::RowVector3d(kMass, 0, 0);
  inertia.C_r = Eigen::RowVector3d::Zero();
  inertia.S_1 = kMass * kRadius * VectorXd::Unit(9, 0);
  body->M_r = Eigen::MatrixXd::Constant(1, 1, kMass).sparseView();
  body->K_r = Eigen::MatrixXd::Constant(1, 1, kSpring).sparseView();
  body->alpha = 10;
  body->surface.Phi = model::DenseRows(0, 1);
  return System({{.name = "arm", .body = body, .joint = hinge(), .rotation = {.s_dot_0 = 4}}}, {}, {level});
}

double state_error(const model::Snapshot& a, const model::Snapshot& b) {
  return std::abs(a.bodies[0].s[0] - b.bodies[0].s[0]) + (a.bodies[0].q - b.bodies[0].q).norm();
}

TEST(Hinge, turns_by_T_t2_over_2J_under_constant_torque) {
  const auto body = std::make_shared<model::ElasticBody>(test::make_rigid_box(soft_box()));
  constexpr double kTorque = 0.7, kTime = 0.5;
  System system(
      {{.name = "box", .body = body, .joint = hinge(), .rotation = {.load = constant_signal(kTorque)}}}, {});
  const model::Snapshot last = last_state(std::move(system), 0.01, kTime);
  const double angle = kTorque * kTime * kTime / (2 * body->inertia.J(2, 2));
  EXPECT_NEAR(last.bodies[0].s[0], angle, kNewton * angle);
  EXPECT_NEAR(last.energy.work, kTorque * angle, kNewton * kTorque * angle);
  EXPECT_NEAR(last.energy.balance, 0, kNewton * last.energy.work);
}

TEST(Hinge, spinning_deformable_body_conserves_energy_and_converges_at_order_two) {
  RunSummary coarse_run, fine_run;
  const auto state = [](double dt, RunSummary* summary) {
    return last_state(spinning_box(InertiaLevel::linear), dt, 1, summary);
  };
  const model::Snapshot reference = state(1. / 3200, nullptr), coarse = state(1. / 200, &coarse_run),
                        fine = state(1. / 400, &fine_run);
  const double error_ratio = state_error(coarse, reference) / state_error(fine, reference);
  const double reference_bias = 1. / 64;  // (dt_fine / dt_reference)^-2
  EXPECT_NEAR(std::log2(error_ratio), 2, kOrder + reference_bias);
  EXPECT_NEAR(std::log2(coarse_run.largest_imbalance / fine_run.largest_imbalance), 2, 2 * kOrder);
  EXPECT_LT(fine_run.largest_imbalance, 1e-3 * fine_run.initial_energy);
  EXPECT_GT(fine.energy.elastic, 1e-3 * fine_run.initial_energy);  // the deformation takes part
}

TEST(Hinge, centrifugal_force_stretches_a_radial_spring_at_level_linear_only) {
  constexpr double kSettled = 10;  // s, 50 decay times of the spring's damping
  const model::Snapshot linear = last_state(radial_spring(InertiaLevel::linear), 0.01, kSettled);
  const double omega = linear.bodies[0].s_dot[0];
  const double stretch = kMass * kRadius * omega * omega / kSpring;
  EXPECT_NEAR(linear.bodies[0].q[0], stretch, 1e-6 * stretch);
  const double J = kHub + kMass * kRadius * kRadius;
  EXPECT_NEAR(omega * (J + 2 * kMass * kRadius * stretch), 4 * J, 1e-6 * 4 * J);  // angular momentum
  const model::Snapshot constant = last_state(radial_spring(InertiaLevel::constant), 0.01, kSettled);
  EXPECT_EQ(constant.bodies[0].q[0], 0);
  EXPECT_EQ(constant.bodies[0].s_dot[0], 4);
}

TEST(Hinge, damping_is_booked_as_dissipated_energy) {
  RunSummary summary;
  const model::Snapshot last = last_state(spinning_box(InertiaLevel::constant, 5), 1. / 400, 1, &summary);
  EXPECT_GE(last.energy.dissipated, 0);
  auto body = std::make_shared<model::ElasticBody>(test::make_box(soft_box(), model::Basis::modal, 10));
  body->alpha = 5;
  System vibrating({{.name = "box", .body = body, .joint = hinge(), .q_dot0 = VectorXd::Ones(10)}}, {},
                   {InertiaLevel::constant});
  const model::Snapshot rest = last_state(std::move(vibrating), 1. / 400, 1, &summary);
  EXPECT_GT(rest.energy.dissipated, 0.5 * summary.initial_energy);
  EXPECT_LT(summary.largest_imbalance, kNewton * summary.initial_energy);  // linear: exact for rho_inf = 1
}

}  // namespace
}  // namespace elastogear::hinge_test
