// Damping and friction of contact in motion, against closed forms. Bodies are rigid with plane or cylindrical
// surfaces, but for one that moves on a spring.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "../contact/surfaces.h"
#include "../figures.h"
#include "contact_bodies.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::friction_test {
using namespace dynamics;
using contact::FrictionLaw;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr const char* kCase = "damping and friction of contact";

model::Surface shifted(model::Surface s, const Vector3d& by) {
  s.X.colwise() += by;
  return s;
}

// Upper side of a plate, z = 0; lower side of a block.
model::Surface plate(double length) { return shifted(contact::test::plane(6, 1, length, 4), {-1, -2, 0}); }
model::Surface block() {
  return shifted(contact::test::flipped(contact::test::plane(2, 2)), {-0.5, -0.5, 0});
}

struct History {
  std::vector<double> time;
  std::vector<model::Snapshot> snapshot;
  RunSummary summary;
};

History run(System& system, double dt, double end_time, double rho_inf = 1) {
  History history;
  history.summary =
      simulate(system, {.dt = dt, .end_time = end_time, .rho_inf = rho_inf}, [&](const model::Snapshot& s) {
        history.time.push_back(s.time);
        history.snapshot.push_back(s);
      });
  return history;
}

// ---- damping

class Restitution : public testing::TestWithParam<double> {};

TEST_P(Restitution, is_that_of_the_damping_law) {
  constexpr double kLaw = 1e-3, kSpeed = 2;
  const double x = GetParam() * kSpeed;  // chi v_0
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.stiffness = 1e6;
  pair.settings.hysteresis = GetParam();
  const auto flying = [&](const char* name, double m, double z, double speed, bool up) {
    BodySetup setup{.name = name, .body = test::rigid_with(up ? plate(2) : block(), m)};
    setup.joint = {.type = body::JointType::prismatic, .axis = {0, 0, 1}, .r_WB0 = {0, 0, z}};
    setup.translation.s_dot_0 = speed;
    return setup;
  };
  System system({flying("a", 2, 1e-4, -kSpeed, false), flying("b", 3, 0, 0, true)}, {pair});
  const History h = run(system, 1e-5, 8e-3);
  const auto speed = [&](int b) { return h.snapshot.back().bodies[b].s_dot[0]; };
  const double e = x == 0 ? 1 : std::sqrt(2 * (x - std::log1p(x))) / x;
  ASSERT_EQ(h.snapshot.back().pairs[0].count, 0);
  EXPECT_GT(h.summary.most_contacts, 0);
  elastogear::test::figure({kCase, "restitution"}, (speed(0) - speed(1)) / kSpeed - e, kLaw);
  EXPECT_NEAR(2 * speed(0) + 3 * speed(1), -2 * kSpeed, 1e-9);
  EXPECT_LT(h.summary.largest_imbalance, kLaw * h.summary.initial_energy);
}

INSTANTIATE_TEST_SUITE_P(Factors, Restitution, testing::Values(0.0, 0.1, 0.5, 2.0));

// ---- friction

constexpr double kMu = 0.3, kSpeed = 5;  // -, m/s
constexpr double kWay = kSpeed * kSpeed / (2 * kMu * kGravity);

// A block that begins to slide along x on a plate.
System block_on_plate(const contact::FrictionSettings& friction, double speed, double g_x) {
  PairSetup pair{"block:plate", {0, 1}, {}};
  pair.settings.stiffness = 1e6;
  pair.settings.damping = 1e4;
  pair.settings.friction = friction;
  BodySetup moving{.name = "block", .body = test::rigid_with(block(), 10)};
  moving.joint = {.type = body::JointType::free, .r_WB0 = {0, 0, -10 * kGravity / 1e6}};
  moving.velocity0 = {speed, 0, 0};
  return System({moving, {.name = "plate", .body = test::rigid_with(plate(12))}}, {pair},
                {.gravity = {g_x, 0, -kGravity}});
}

class Sliding : public testing::TestWithParam<contact::FrictionSettings> {};

TEST_P(Sliding, stops_after_the_way_of_Coulomb_friction) {
  constexpr double kLaw = 0.005;
  System system = block_on_plate(GetParam(), kSpeed, 0);
  const History h = run(system, 2e-3, 1.9, 0.8);
  const model::Snapshot& last = h.snapshot.back();
  elastogear::test::figure({kCase, "sliding distance", "%"}, last.bodies[0].s[0] / kWay - 1, kLaw);
  EXPECT_LT(last.bodies[0].s_dot.head<3>().norm(), 1e-2);
  const double lost = 0.5 * 10 * kSpeed * kSpeed;
  EXPECT_NEAR(last.energy.dissipated, lost, 0.01 * lost);
  EXPECT_LT(h.summary.largest_imbalance, 0.01 * lost);
}

INSTANTIATE_TEST_SUITE_P(Laws, Sliding,
                         testing::Values(contact::FrictionSettings{.mu = kMu, .v_0 = 1e-3},
                                         contact::FrictionSettings{.mu = kMu, .law = FrictionLaw::stick}));

// The block stands on a plate that is inclined by less than the angle of friction.
TEST(Sticking, stays_where_regularised_friction_creeps) {
  const auto way = [](const contact::FrictionSettings& friction) {
    System system = block_on_plate(friction, 0, 0.2 * kGravity);
    const History h = run(system, 2e-3, 1, 0.8);
    return h.snapshot.back().bodies[0].s[0];
  };
  const double spring = 0.2 * 10 * kGravity / 1e6;  // deflection; it swings about it
  EXPECT_LT(way({.mu = kMu, .law = FrictionLaw::stick}), 3 * spring);
  EXPECT_GT(way({.mu = kMu, .v_0 = 1e-2}), 100 * spring);
}

// ---- stick-slip

// A surface on a spring along y: one elastic coordinate, its rigid translation.
std::shared_ptr<const model::ElasticBody> on_spring(double m, double omega) {
  auto body = test::rigid_with(block(), m);
  const auto n_s = body->surface.X.cols();
  model::DenseRows Phi = model::DenseRows::Zero(3 * n_s, 1);
  for (Eigen::Index i = 0; i < n_s; ++i) Phi(3 * i + 1, 0) = 1 / std::sqrt(m);
  body->surface.Phi = Phi;
  body->M_r = Eigen::MatrixXd::Identity(1, 1).sparseView();
  body->K_r = (omega * omega * body->M_r).eval();
  body->frequency = VectorXd::Constant(1, omega / (2 * std::numbers::pi));
  body->inertia.C_l.setZero(1, 3);
  body->inertia.C_l(0, 1) = std::sqrt(m);
  body->inertia.C_r.setZero(1, 3);
  body->inertia.S_1.setZero(9, 1);
  return body;
}

TEST(StickSlip, of_a_block_on_a_spring_has_the_period_and_the_peak_of_the_closed_form) {
  constexpr double m = 2, omega = 20, belt = 0.1, mu_s = 0.4, mu = 0.25, N = 100, kLaw = 0.01;
  PairSetup pair{"block:belt", {0, 1}, {}};
  pair.settings.stiffness = 1e7;
  pair.settings.friction = {.mu = mu, .mu_static = mu_s, .law = FrictionLaw::stick};
  BodySetup block_setup{.name = "block", .body = on_spring(m, omega)};
  block_setup.joint.r_WB0 = {0, 0, -N / 1e7};
  BodySetup moving{.name = "belt", .body = test::rigid_with(plate(12))};
  moving.joint = {.type = body::JointType::prismatic, .axis = {0, 1, 0}};
  moving.translation.drive = speed_drive(0, belt);
  System system({block_setup, moving}, {pair});
  const History h = run(system, 2e-3, 2.4, 0.5);  // damps the vibration of the tangential spring

  const double k = m * omega * omega, step = (mu_s - mu) * N / k;
  const double period = 2 * step / belt + 2 / omega * (std::numbers::pi - std::atan(step * omega / belt));
  const double peak = mu * N / k + std::hypot(step, belt / omega);
  std::vector<double> peaks;
  double largest = 0;
  for (std::size_t i = 1; i + 1 < h.snapshot.size(); ++i) {
    const auto x = [&](std::size_t j) { return h.snapshot[j].bodies[0].q[0] / std::sqrt(m); };
    if (x(i) < x(i - 1) || x(i) <= x(i + 1) || x(i) < 0.9 * peak) continue;
    peaks.push_back(h.time[i]);
    largest = std::max(largest, x(i));
  }
  ASSERT_GE(peaks.size(), 3u);
  EXPECT_NEAR((peaks.back() - peaks.front()) / static_cast<double>(peaks.size() - 1), period, kLaw * period);
  EXPECT_NEAR(largest, peak, kLaw * peak);
  EXPECT_LT(h.summary.largest_imbalance, kLaw * h.snapshot.back().energy.dissipated);
}

// ---- rolling

constexpr double kRadius = 0.5, kOverlap = 1e-3;  // m

model::Surface roller(int n) {
  model::Surface s;
  s.X.resize(3, 2 * n);
  s.face.resize(4, n);
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * i / n;
    s.X.col(i) = Vector3d(kRadius * std::sin(phi), -0.1, kRadius * std::cos(phi));
    s.X.col(n + i) = s.X.col(i) + 0.2 * Vector3d::UnitY();
    s.face.col(i) << i, (i + 1) % n, n + (i + 1) % n, n + i;
  }
  s.c_f = VectorXd::Constant(n, 1e12);
  return s;
}

// One roller spins up the other; slip, and what friction takes, end when both have the same speed.
TEST(Rolling, friction_takes_what_the_rollers_lose) {
  constexpr double kSpin = 4, kLaw = 0.01;
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.stiffness = 1e8;
  pair.settings.surface = contact::ContactSurface::smooth;
  pair.settings.two_pass = true;
  pair.settings.friction = {.mu = 0.2, .v_0 = 1e-2};
  const auto turning = [&](const char* name, double z, double spin) {
    BodySetup setup{.name = name, .body = test::rigid_with(roller(360), 20)};
    setup.joint = {.type = body::JointType::revolute, .axis = {0, 1, 0}, .r_WB0 = {0, 0, z}};
    setup.rotation.s_dot_0 = spin;
    return setup;
  };
  System system({turning("a", 0, kSpin), turning("b", 2 * kRadius - kOverlap, 0)}, {pair});
  const History h = run(system, 1e-3, 0.25, 0.8);
  const model::Snapshot& last = h.snapshot.back();
  const double J = 20.0 / 6, lost = 0.5 * J * kSpin * kSpin / 2;
  EXPECT_NEAR(last.bodies[0].s_dot[0], kSpin / 2, kLaw * kSpin);
  EXPECT_NEAR(last.bodies[1].s_dot[0], -kSpin / 2, kLaw * kSpin);
  EXPECT_NEAR(last.energy.dissipated, lost, kLaw * lost);
  EXPECT_LT(h.summary.largest_imbalance, kLaw * lost);
  double work = 0;
  for (std::size_t i = 1; i < h.time.size(); ++i)
    work += (h.time[i] - h.time[i - 1]) / 2 *
            (h.snapshot[i].pairs[0].total.friction_power + h.snapshot[i - 1].pairs[0].total.friction_power);
  EXPECT_NEAR(work, lost, kLaw * lost);
}

}  // namespace
}  // namespace elastogear::friction_test
