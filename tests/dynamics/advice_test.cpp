// What a run is advised to do, against vibrations known by hand.
#include "elastogear/dynamics/advice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "../body/random_body.h"
#include "box_body.h"
#include "dynamics/run/snapshot.h"

namespace elastogear::advice_test {
using namespace dynamics;

namespace {

constexpr double kRoundoff = 1e-12;

std::shared_ptr<const model::ElasticBody> block(model::Basis basis = model::Basis::modal) {
  test::BoxSpec spec{.size = {1, 1, 1}, .cells = {2, 1, 1}, .material = {1e4, 0.3, 1}};
  spec.held = [](const auto& X, int) { return X.x() == 0; };
  return std::make_shared<model::ElasticBody>(test::make_box(spec, basis));
}

System turning(double speed, body::InertiaLevel level = body::InertiaLevel::affine) {
  return System({{.name = "block",
                  .body = block(),
                  .joint = {.type = body::JointType::revolute},
                  .rotation = {.s_dot_0 = speed}}},
                {}, {.inertia = level});
}

model::Snapshot start(System& system, double stretch) {
  Eigen::VectorXd U = system.initial_position(), V = system.initial_velocity();
  U[1] = stretch;
  return snapshot(system, {0, U, V, V});
}

TEST(Advice, asks_for_ten_steps_in_a_period_of_the_highest_mode) {
  const System system = turning(0);
  const Advice advice = advise(system);
  const double highest = block()->frequency.maxCoeff();
  EXPECT_EQ(advice.mode.name, "block");
  EXPECT_NEAR(advice.step() * highest, 0.1, kRoundoff);
  EXPECT_EQ(advice.contact.frequency, 0);
  EXPECT_TRUE(std::isinf(advice.contact.step()));
}

TEST(Advice, contact_vibrates_by_the_penalty_on_the_mass_of_a_node) {
  constexpr double kStiffness = 1e6;
  const auto body = block(model::Basis::full);
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.penalty = contact::Penalty::per_node;
  pair.settings.stiffness = kStiffness;
  pair.settings.depth = 0.1;
  const System system(
      {{.name = "a", .body = body}, {.name = "b", .body = body, .joint = {.r_WB0 = {2, 0, 0}}}}, {pair});
  const Advice advice = advise(system);
  double mass = 0;  // of the touched nodes at x = 1: all are corners of one cell
  for (int k = 0; k < body->M_r.rows(); ++k)
    mass = mass == 0 ? body->M_r.coeff(k, k) : std::min(mass, body->M_r.coeff(k, k));
  EXPECT_NEAR(advice.contact.frequency, std::sqrt(kStiffness / mass) / (2 * std::numbers::pi),
              kRoundoff * advice.contact.frequency);
  EXPECT_EQ(advice.mode.frequency, 0) << "a full basis has no modes";
}

TEST(ValidityGuard, is_silent_while_all_is_small) {
  System system = turning(0.01);
  ValidityGuard guard(system);
  EXPECT_TRUE(guard.warnings(start(system, 1e-9)).empty());
}

TEST(ValidityGuard, warns_once_of_a_large_deformation) {
  System system = turning(0);
  ValidityGuard guard(system);
  const auto warnings = guard.warnings(start(system, 1));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("body 'block' at t = 0 s: elastic rotation or strain"), std::string::npos)
      << warnings[0];
  EXPECT_TRUE(guard.warnings(start(system, 1)).empty());
}

TEST(ValidityGuard, warns_where_the_edges_change_by_a_twentieth_whatever_the_energy) {
  const auto body = block();
  const model::Surface& surface = body->surface;
  Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(body->n_q(), 1, -1);
  double largest = 0;
  for (Eigen::Index f = 0; f < surface.face.cols(); ++f)
    for (int i : {0, 1, 2}) {
      const int a = surface.face(i, f), b = surface.face(i + 1, f);
      const Eigen::Vector3d u =
          model::displacement(surface.Phi, a, q) - model::displacement(surface.Phi, b, q);
      largest = std::max(largest, u.norm() / (surface.X.col(a) - surface.X.col(b)).norm());
    }
  System system = turning(0);
  model::Snapshot now = start(system, 0);
  now.bodies[0].q = 0.0499 / largest * q;
  EXPECT_TRUE(ValidityGuard(system).warnings(now).empty());
  now.bodies[0].q = 0.0501 / largest * q;
  EXPECT_EQ(ValidityGuard(system).warnings(now).size(), 1u);
}

TEST(ValidityGuard, warns_once_of_a_fast_rotation) {
  System system =
      turning(2 * std::numbers::pi * 0.2 * block()->frequency.minCoeff(), body::InertiaLevel::full);
  ValidityGuard guard(system);
  const auto warnings = guard.warnings(start(system, 0));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("lowest mode: 0.2"), std::string::npos) << warnings[0];
  EXPECT_TRUE(guard.warnings(start(system, 0)).empty());
}

// A thin ring of radius 1 m and 1 kg in its plane, of point masses: two inextensional bending modes each of n
// = 2, 3 and 4 waves, omega_n ~ n (n^2 - 1) / sqrt(n^2 + 1), the lowest 1 rad/s (A. E. H. Love, Theory of
// Elasticity, section 293).
constexpr int kWaves[] = {2, 3, 4};

double ring_frequency(int n) { return n * (n * n - 1) / std::sqrt(n * n + 1) / (6 / std::sqrt(5)); }

std::shared_ptr<const model::ElasticBody> ring() {
  constexpr int kPoints = 24;
  Eigen::Matrix3Xd X(3, kPoints);
  Eigen::MatrixXd Phi(3 * kPoints, 6);
  for (int p = 0; p < kPoints; ++p) {
    const double angle = 2 * std::numbers::pi * p / kPoints;
    const Eigen::Vector3d radial(std::cos(angle), std::sin(angle), 0),
        tangential(-std::sin(angle), std::cos(angle), 0);
    X.col(p) = radial;
    for (int k = 0; k < 6; ++k) {
      const int n = kWaves[k / 2];
      const double phase = n * angle - (k % 2) * std::numbers::pi / 2;
      Phi.block<3, 1>(3 * p, k) =
          (std::cos(phase) * radial - std::sin(phase) / n * tangential) / std::sqrt(0.5 + 0.5 / (n * n));
    }
  }
  auto body = std::make_shared<model::ElasticBody>();
  test::set_inertia(Eigen::VectorXd::Constant(kPoints, 1. / kPoints), X, Phi, *body);
  body->inertia.J(0, 0) += 1e-6;  // of the thickness
  body->inertia.J(1, 1) += 1e-6;
  Eigen::VectorXd omega(6);
  for (int k = 0; k < 6; ++k) omega[k] = ring_frequency(kWaves[k / 2]);
  body->frequency = omega / (2 * std::numbers::pi);
  body->K_r = Eigen::MatrixXd(omega.cwiseAbs2().asDiagonal()).sparseView();
  return body;
}

System spinning_ring(body::InertiaLevel level, double speed) {
  return System({{.name = "ring",
                  .body = ring(),
                  .joint = {.type = body::JointType::revolute, .axis = {0, 0, 1}},
                  .rotation = {.s_dot_0 = speed}}},
                {}, {.inertia = level});
}

// b of (8.18a): Coriolis force on the second of a pair of modes from the velocity of the first, per 2 Omega.
double coupling(body::InertiaLevel level, int n) {
  const System system = spinning_ring(level, 1);
  const body::Equations& eq = system.bodies()[0].eq;
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1), none = Eigen::VectorXd::Zero(6);
  const Eigen::VectorXd q_dot = Eigen::VectorXd::Unit(6, 2 * (n - 2));
  const auto force = [&](const Eigen::VectorXd& rates) {
    return body::quadratic_force(eq, {0 * one, one, 0 * one, none, rates, none}).q[2 * (n - 2) + 1];
  };
  return std::abs(force(q_dot) - force(none)) / 2;
}

TEST(ValidityGuard, bounds_what_a_spinning_ring_loses_of_its_split_frequencies) {
  constexpr double kSpeed = 0.09;  // of the lowest frequency
  double largest = 0;
  for (int n : kWaves) {
    const double b = coupling(body::InertiaLevel::full, n);
    EXPECT_NEAR(b, 2. * n / (n * n + 1), kRoundoff) << n;
    EXPECT_NEAR(coupling(body::InertiaLevel::affine, n), n == 2 ? 0.9 : 0, kRoundoff) << n;
    const double lost = std::abs(b - coupling(body::InertiaLevel::affine, n));
    largest = std::max(largest, kSpeed * lost / ring_frequency(n));
  }
  EXPECT_NEAR(largest, 0.019, 0.0005);
  System system = spinning_ring(body::InertiaLevel::affine, kSpeed);
  ValidityGuard guard(system);
  const Eigen::VectorXd U = system.initial_position(), V = system.initial_velocity();
  const auto warnings = guard.warnings(snapshot(system, {0, U, V, V}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("-inertia full"), std::string::npos) << warnings[0];
  const double said = std::stod(warnings[0].substr(warnings[0].rfind(' ')));
  EXPECT_NEAR(said, kSpeed / ring_frequency(3), 1e-4);
  EXPECT_GT(said, largest);
  EXPECT_TRUE(guard.warnings(snapshot(system, {0, U, V, V})).empty());
}

TEST(ValidityGuard, says_nothing_of_level_full_and_of_gears_that_turn_slowly) {
  for (const auto& [level, speed] :
       {std::pair(body::InertiaLevel::full, 0.09), {body::InertiaLevel::affine, 0.001}}) {
    System system = spinning_ring(level, speed);
    const Eigen::VectorXd U = system.initial_position(), V = system.initial_velocity();
    EXPECT_TRUE(ValidityGuard(system).warnings(snapshot(system, {0, U, V, V})).empty()) << speed;
  }
}

TEST(ValidityGuard, warns_once_of_contact_beside_the_nodes_with_static_responses) {
  test::BoxSpec spec{.size = {1, 1, 1}, .cells = {2, 1, 1}, .material = {1e4, 0.3, 1}};
  spec.held = [](const auto& X, int) { return X.x() == 0; };
  const auto body = std::make_shared<model::ElasticBody>(test::make_flexible_box(spec, 1));
  const int beside = body->flexibility.node.back(), loaded = body->flexibility.node.front();
  body->flexibility.node.pop_back();
  System system({{.name = "block", .body = body}}, {});
  ValidityGuard guard(system);
  const Eigen::VectorXd U = system.initial_position();
  model::Snapshot now = snapshot(system, {0, U, U, U});
  now.bodies[0].contact = {{loaded, beside}, Eigen::Matrix3Xd::Zero(3, 2)};
  EXPECT_TRUE(guard.warnings(now).empty());
  now.bodies[0].contact.f_B << 0.96, 0, 0, 0.04, 0, 0;
  EXPECT_TRUE(guard.warnings(now).empty());
  now.bodies[0].contact.f_B << 3, 0, 0, 1, 0, 0;
  const auto warnings = guard.warnings(now);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("body 'block' at t = 0 s: contact acts on nodes"), std::string::npos)
      << warnings[0];
  EXPECT_NE(warnings[0].find("forces: 0.25"), std::string::npos) << warnings[0];
  EXPECT_TRUE(guard.warnings(now).empty());
}

TEST(ValidityGuard, warns_once_of_steps_longer_than_the_contact_depth) {
  PairSetup pair{"a:b", {0, 1}, {.depth = 0.01, .friction = {}}};
  const auto rigid = std::make_shared<model::ElasticBody>(test::make_rigid_box({.material = {1, 0, 1}}));
  pair.settings.stiffness = 1;
  const body::Joint slide{.type = body::JointType::prismatic, .axis = {1, 0, 0}};
  System system({{.name = "a", .body = rigid, .joint = slide, .translation = {.s_dot_0 = 3}},
                 {.name = "b", .body = rigid, .joint = {.r_WB0 = {5, 0, 0}}}},
                {pair});
  const Eigen::VectorXd U = system.initial_position(), V = system.initial_velocity();
  const model::Snapshot now = snapshot(system, {0, U, V, V});
  EXPECT_TRUE(ValidityGuard(system, 0.003).warnings(now).empty());
  ValidityGuard guard(system, 0.004);
  const auto warnings = guard.warnings(now);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("pair a:b at t = 0 s: surfaces may pass"), std::string::npos) << warnings[0];
  EXPECT_TRUE(guard.warnings(now).empty());
}

// Two blocks with residual flexibility beside each other, in contact without a penalty.
System blocks_without_penalty() {
  test::BoxSpec spec{.size = {1, 1, 1}, .cells = {2, 1, 1}, .material = {1e4, 0.3, 1}};
  spec.held = [](const auto& X, int) { return X.x() == 0; };
  const auto body = std::make_shared<model::ElasticBody>(test::make_flexible_box(spec, 1));
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.law = contact::ContactLaw::unilateral;
  return System({{.name = "a", .body = body}, {.name = "b", .body = body, .joint = {.r_WB0 = {2, 0, 0}}}},
                {pair});
}

// What a watch says while the force of the pair is that of 500 states one after the other.
std::vector<std::string> said_of(System& system, const std::function<double(int state)>& force) {
  ChatterWatch watch(system);
  const Eigen::VectorXd U = system.initial_position();
  model::Snapshot now = snapshot(system, {0, U, U, U});
  std::vector<std::string> said;
  for (int state = 0; state < 500; ++state) {
    now.time = 1e-3 * state;
    now.pairs[0].force = force(state) * Eigen::Vector3d::UnitX();
    for (const std::string& sentence : watch.warnings(now)) said.push_back(sentence);
  }
  return said;
}

TEST(ChatterWatch, warns_once_of_a_force_that_goes_to_and_fro) {
  System system = blocks_without_penalty();
  const auto said = said_of(system, [](int state) { return state % 2 == 0 ? 10.0 : 0.0; });
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("contact a:b at t = 0.049 s: chatters"), std::string::npos) << said[0];
  EXPECT_NE(said[0].find("-contact_law penalty"), std::string::npos) << said[0];
}

// A force of mean 1 N that vibrates by so many Hz.
auto vibration(double amplitude, double frequency) {
  return [=](int state) { return 1 + amplitude * std::sin(2 * std::numbers::pi * frequency * 1e-3 * state); };
}

TEST(ChatterWatch, warns_of_a_force_that_vibrates_beyond_the_modes) {
  System system = blocks_without_penalty();
  const double mode = system.bodies()[0].eq.body->frequency[0];
  const auto said = said_of(system, vibration(0.6, 1.2 * mode));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("a shock has more than these modes"), std::string::npos) << said[0];
  EXPECT_TRUE(said_of(system, vibration(0.6, 0.4 * mode)).empty());
  EXPECT_TRUE(said_of(system, vibration(0.3, 1.2 * mode)).empty());
}

TEST(ChatterWatch, is_silent_of_forces_that_vibrate_or_rise) {
  System system = blocks_without_penalty();
  const double mode = system.bodies()[0].eq.body->frequency[0];
  EXPECT_TRUE(said_of(system, vibration(1, 0.4 * mode)).empty()) << mode;
  EXPECT_TRUE(said_of(system, [](int state) { return state; }).empty());
  EXPECT_TRUE(said_of(system, [](int state) { return state % 2 == 0 ? 10.0 : 6.0; }).empty());
  EXPECT_TRUE(said_of(system, [](int) { return 0; }).empty());
}

TEST(ChatterWatch, leaves_contact_with_a_penalty_out) {
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.stiffness = 1;
  System system(
      {{.name = "a", .body = block()}, {.name = "b", .body = block(), .joint = {.r_WB0 = {2, 0, 0}}}},
      {pair});
  EXPECT_TRUE(said_of(system, [](int state) { return state % 2 == 0 ? 10.0 : 0.0; }).empty());
}

}  // namespace
}  // namespace elastogear::advice_test
