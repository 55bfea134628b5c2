// The equations of motion against Lagrange's equations of their own kinetic energy, differenced numerically.
#include <gtest/gtest.h>

#include <random>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/body/equations.h"

using namespace elastogear;
using body::Equations;
using body::InertiaLevel;
using body::Motion;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kStep = 1e-5;        // of central differences; all quantities are of order one
constexpr double kDifference = 1e-8;  // roundoff / kStep; T is quadratic or cubic in every argument
constexpr double kRoundoff = 1e-13;
constexpr int kModes = 4;

std::shared_ptr<model::ElasticBody> random_body() {
  std::mt19937 generator(1);
  const auto random = [&](auto& x) {
    for (auto& value : x.reshaped()) value = std::uniform_real_distribution<>(-1, 1)(generator);
  };
  auto body = std::make_shared<model::ElasticBody>();
  model::Inertia& inertia = body->inertia;
  inertia.m = 3;
  random(inertia.c);
  inertia.J = Vector3d(8, 9, 10).asDiagonal();
  inertia.C_l.resize(kModes, 3);
  inertia.C_r.resize(kModes, 3);
  inertia.S_1.resize(9, kModes);
  random(inertia.C_l);
  random(inertia.C_r);
  random(inertia.S_1);
  body->M_r = Eigen::MatrixXd::Identity(kModes, kModes).sparseView();
  body->K_r = Eigen::MatrixXd(Eigen::Vector4d(1, 2, 3, 4).asDiagonal()).sparseView();
  return body;
}

Equations hinged(InertiaLevel level) {
  return make_equations(random_body(), {.type = body::JointType::revolute, .axis = {1, 2, -2}}, level);
}

Motion some_motion(int n_s) {
  std::srand(2);
  Motion m;
  for (VectorXd* x : {&m.s, &m.s_dot, &m.s_ddot}) *x = VectorXd::Random(n_s);
  for (VectorXd* x : {&m.q, &m.q_dot, &m.q_ddot}) *x = VectorXd::Random(kModes);
  return m;
}

// The motion a time h later, at constant accelerations.
Motion later(const Motion& m, double h) {
  Motion n = m;
  n.q = m.q + h * m.q_dot + h * h / 2 * m.q_ddot;
  n.q_dot = m.q_dot + h * m.q_ddot;
  n.s_dot = m.s_dot + h * m.s_ddot;
  return n;
}

double difference(const auto& f) { return (f(kStep) - f(-kStep)) / (2 * kStep); }

double momentum(const Equations& eq, const Motion& m, VectorXd Motion::*velocity, int i) {
  return difference([&](double h) {
    Motion n = m;
    (n.*velocity)[i] += h;
    return kinetic_energy(eq, n);
  });
}

double momentum_rate(const Equations& eq, const Motion& m, VectorXd Motion::*velocity, int i) {
  constexpr double kLongStep = 1e-3;  // the inner difference's roundoff must stay small; terms are cubic in h
  const auto p = [&](double h) { return momentum(eq, later(m, h), velocity, i); };
  return (8 * (p(kLongStep) - p(-kLongStep)) - (p(2 * kLongStep) - p(-2 * kLongStep))) / (12 * kLongStep);
}

class EquationsOfMotion : public testing::TestWithParam<InertiaLevel> {};

}  // namespace

TEST_P(EquationsOfMotion, follow_from_the_kinetic_energy) {
  const Equations eq = hinged(GetParam());
  const Motion m = some_motion(1);
  const body::Force inertia = inertia_force(eq, m), quadratic = quadratic_force(eq, m);
  constexpr double kTwiceDifferenced = 1e-6;
  EXPECT_NEAR(inertia.s[0] - quadratic.s[0], momentum_rate(eq, m, &Motion::s_dot, 0), kTwiceDifferenced);
  for (int k = 0; k < kModes; ++k) {
    const double dT_dq = momentum(eq, m, &Motion::q, k);
    EXPECT_NEAR(inertia.q[k] - quadratic.q[k], momentum_rate(eq, m, &Motion::q_dot, k) - dT_dq,
                kTwiceDifferenced);
  }
}

TEST_P(EquationsOfMotion, power_of_inertia_is_the_rate_of_kinetic_energy) {
  const Equations eq = hinged(GetParam());
  const Motion m = some_motion(1);
  const body::Force inertia = inertia_force(eq, m), quadratic = quadratic_force(eq, m);
  const double power = m.s_dot.dot(inertia.s - quadratic.s) + m.q_dot.dot(inertia.q - quadratic.q);
  EXPECT_NEAR(power, difference([&](double h) { return kinetic_energy(eq, later(m, h)); }), kDifference);
}

INSTANTIATE_TEST_SUITE_P(Levels, EquationsOfMotion,
                         testing::Values(InertiaLevel::constant, InertiaLevel::linear));

TEST(Equations, joint_inertia_is_the_moment_of_inertia_about_the_axis) {
  const Equations eq = hinged(InertiaLevel::linear);
  const Vector3d a = Vector3d(1, 2, -2) / 3;
  EXPECT_NEAR(eq.M_ss(0, 0), a.dot(eq.body->inertia.J * a), kRoundoff);
  EXPECT_NEAR(eq.M_ss_1(0, 2), a.dot(model::J_1(eq.body->inertia, 2) * a), kRoundoff);
}

TEST(Equations, a_fixed_body_has_elastic_inertia_only) {
  const Equations eq = make_equations(random_body(), {}, InertiaLevel::linear);
  const Motion m = some_motion(0);
  EXPECT_EQ(inertia_force(eq, m).q, m.q_ddot);
  EXPECT_EQ(quadratic_force(eq, m).q, VectorXd::Zero(kModes));
}

TEST(Joint, revolute_turns_about_its_axis_from_its_own_placement) {
  const Eigen::Matrix3d R_0 = rotation_matrix({0.3, -0.2, 0.9});
  const body::Joint joint{body::JointType::revolute, {0, 0, 2}, {1, 2, 3}, R_0};
  const auto [r_WB, R_WB] = placement(joint, motion_subspace(joint), VectorXd::Constant(1, 0.5));
  EXPECT_EQ(r_WB, Vector3d(1, 2, 3));
  EXPECT_NEAR((R_WB - R_0 * rotation_matrix({0, 0, 0.5})).norm(), 0, kRoundoff);
}

TEST(Joint, refuses_an_axis_without_direction) {
  EXPECT_THROW(body::motion_subspace({body::JointType::revolute, {0, 0, 0}}), Error);
  EXPECT_THROW(body::motion_subspace({body::JointType::revolute, {0, NAN, 1}}), Error);
}
