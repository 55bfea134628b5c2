// The residual of a system and its Jacobian, with rotation, both inertia levels and contact.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "box_body.h"
#include "dynamics/run/snapshot.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::system_test {
using namespace dynamics;
using body::InertiaLevel;
using body::JointType;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kStep = 1e-6;        // of central differences, against sizes of order one
constexpr double kDifference = 1e-7;  // relative: roundoff / kStep, and kStep^2 curvature
constexpr double kThinLayer = 2e-3;   // relative: what the tangent of friction leaves out, (0.01 / 0.25)^2
constexpr double kTrials = 1e-4;      // relative: contact forces fit the answers to them to 1e-10 / kStep
constexpr double kSplit = 1e-3;  // relative: two passes share a force among more contacts than it determines
constexpr double kImpulse = 1e-6;  // relative: roundoff and curvature of forces far above the others
constexpr double kRoundoff = 1e-12;
constexpr double kTime = 0.3;

// Held at its far end, with residual flexibility.
std::shared_ptr<const model::ElasticBody> flexible_box(const Vector3d& corner, double held_at, int n_modes) {
  return std::make_shared<model::ElasticBody>(test::make_flexible_box(
      {.corner = corner,
       .size = {2, 1, 1},
       .cells = {2, 2, 2},
       .material = {100, 0.3, 1},
       .held = [=](const Vector3d& X, int) { return std::abs(X[0] - held_at) < 1e-9; }},
      n_modes));
}

struct Options {
  InertiaLevel level = InertiaLevel::linear;
  bool two_pass = false;
  int slave = 0;
  model::Basis basis = model::Basis::modal;
  JointType joint = JointType::revolute;  // of a
  Axis rotation = {.load = constant_signal(0.3)};
  double damping = 0, friction = 0;  // of the contact; flexible: hysteresis only
  double depth = 0.02;
  bool flexible = false;
  bool unilateral = false;
  bool impact = false;                               // in a step of bodies without residual flexibility
  bool sticks = false;                               // friction, since the state at the start
  double extension = contact::Settings{}.extension;  // 0: without forces that push nodes off free boundaries
};

// Two hinged boxes, end against end, tilted a little, 0.02 deep in each other.
System two_boxes(const Options& options) {
  std::vector<BodySetup> bodies(2);
  bodies[0] = {.name = "a",
               .body = test::make_damped_box({0, -0.5, -0.5}, {2, 2, 2}, options.basis, 14),
               .joint = {.type = options.joint, .axis = {0, 0.2, 1}, .point = {0.1, 0.2, -0.3}},
               .rotation = options.rotation};
  bodies[1] = {.name = "b",
               .body = test::make_damped_box({-2, -0.5, -0.5}, {2, 3, 2}, options.basis, 15),
               .joint = {JointType::revolute,
                         {1, 3, -1},
                         {4 - options.depth, 0.03, 0.04},
                         rotation_matrix({0.2, 0.005, -0.01})}};
  if (options.flexible) {
    bodies[0].body = flexible_box({0, -0.5, -0.5}, 0, 14);
    bodies[1].body = flexible_box({-2, -0.5, -0.5}, 0, 10);
  }
  PairSetup pair{"a:b", {0, 1}, {}};
  pair.settings.penalty = contact::Penalty::per_node;
  pair.settings.stiffness = 50;
  pair.settings.two_pass = options.two_pass;
  pair.settings.slave = options.slave;
  pair.settings.extension = options.extension;
  pair.settings.damping = options.flexible ? 0 : options.damping;
  pair.settings.hysteresis = options.damping;
  pair.settings.friction = {.mu = options.friction, .v_0 = 0.4};
  if (options.sticks) pair.settings.friction.law = contact::FrictionLaw::stick;
  if (options.impact) pair.settings.damping = pair.settings.hysteresis = 0;
  pair.settings.law =
      options.unilateral || options.impact ? contact::ContactLaw::unilateral : contact::ContactLaw::penalty;
  return System(bodies, {pair}, {.inertia = options.level, .gravity = {1, -2, 3}});
}

struct Values {
  VectorXd U, V, A;
  operator State() const { return {kTime, U, V, A}; }
};

Values some_state(const System& system) {
  std::srand(4);
  return {system.initial_position() + 0.002 * VectorXd::Random(system.size()),
          VectorXd::Random(system.size()), VectorXd::Random(system.size())};
}

// Answers of residual flexibility that start from those of a state nearby need no step to first order only.
VectorXd settled_residual(System& system, const Values& s) {
  system.residual(Values{s.U * (1 + kRoundoff), s.V, s.A});
  return system.residual(s).F;
}

// dF along (x, shift_v x, shift_a x)
VectorXd difference(System& system, const Values& s, const VectorXd& x, double step, double shift_v,
                    double shift_a) {
  const auto F = [&](double h) {
    const VectorXd dx = h * x;
    return settled_residual(system, {s.U + dx, s.V + shift_v * dx, s.A + shift_a * dx});
  };
  return (F(step) - F(-step)) / (2 * step);
}

void expect_jacobian_is_derivative(System& system, double tolerance, double step = kStep) {
  constexpr double kShiftV = 3, kShiftA = 20;
  const Values s = some_state(system);
  LowRankSolver solver(system.solver_bodies());
  settled_residual(system, s);
  solver.set(system.effective_matrix(s, {kShiftV, kShiftA}));
  for (Eigen::Index j = 0; j < system.size(); ++j) {
    const VectorXd unit = VectorXd::Unit(system.size(), j), column = solver.multiply(unit);
    EXPECT_LT((column - difference(system, s, unit, step, kShiftV, kShiftA)).norm(),
              tolerance * column.norm())
        << "column " << j;
  }
}

class Jacobian : public testing::TestWithParam<Options> {};

BodySetup named(const std::string& name) {
  return {.name = name, .body = test::make_damped_box({0, 0, 0}, {1, 1, 1}, model::Basis::modal, 3)};
}

TEST_P(Jacobian, is_the_derivative_of_the_residual) {
  System system = two_boxes(GetParam());
  const Values s = some_state(system);
  if (GetParam().sticks) system.accept(Values{system.initial_position(), s.V, s.A});
  if (GetParam().impact) {
    system.begin_step(0, 1);
    system.accept(Values{s.U, -s.V, s.A});
    system.begin_step(0.1, 0.7);
  }
  const auto& points = system.contacts(kTime, s.U, s.V).pair[0].points;
  ASSERT_GE(points.size(), GetParam().impact ? 1u : 3u);
  ASSERT_EQ(points[0].tangential.has_value(), GetParam().sticks && !GetParam().impact);
  const bool split = GetParam().unilateral && GetParam().two_pass;
  const double tolerance = GetParam().impact     ? kImpulse
                           : split               ? kSplit
                           : GetParam().flexible ? kTrials
                                                 : kDifference;
  // The forces of contacts without a penalty are larger, and so is their roundoff.
  expect_jacobian_is_derivative(system, GetParam().friction > 0 ? kThinLayer : tolerance,
                                GetParam().unilateral || GetParam().impact ? 10 * kStep : kStep);
}

INSTANTIATE_TEST_SUITE_P(
    Levels, Jacobian,
    testing::Values(
        Options{InertiaLevel::constant}, Options{InertiaLevel::linear}, Options{InertiaLevel::linear, true},
        Options{InertiaLevel::linear, false, 1}, Options{.basis = model::Basis::full},
        Options{.rotation = {.damping = 0.7, .friction = 0.5, .friction_rate = 0.4}},
        Options{
            .rotation = {.law = [](double t, double s, double v) { return t - 20 * s + std::sin(3 * v); }}},
        Options{.rotation = {.drive = spin_up_drive(-0.0045, 0.1, 1)}},
        Options{.joint = JointType::cylindrical, .rotation = {.drive = spin_up_drive(-0.0045, 0.1, 1)}},
        Options{.level = InertiaLevel::affine},
        Options{.level = InertiaLevel::affine, .two_pass = true, .friction = 0.4, .depth = 0.006},
        Options{.level = InertiaLevel::affine, .joint = JointType::free, .rotation = {}, .damping = 2},
        Options{.level = InertiaLevel::affine, .damping = 2, .flexible = true},
        Options{.level = InertiaLevel::affine, .basis = model::Basis::full},
        Options{.level = InertiaLevel::full},
        Options{.level = InertiaLevel::full, .basis = model::Basis::full}, Options{.damping = 2},
        Options{.basis = model::Basis::full, .damping = 2},
        Options{.joint = JointType::spherical, .rotation = {}, .damping = 2},
        Options{.joint = JointType::free, .rotation = {}, .damping = 2},
        Options{.two_pass = true, .friction = 0.4, .depth = 0.006},
        Options{.joint = JointType::free, .rotation = {}, .friction = 0.4, .depth = 0.006},
        Options{.flexible = true}, Options{.two_pass = true, .flexible = true},
        Options{.damping = 2, .flexible = true},
        Options{.two_pass = true, .friction = 0.4, .depth = 0.006, .flexible = true},
        Options{.flexible = true, .unilateral = true},
        Options{.two_pass = true, .flexible = true, .unilateral = true},
        Options{.two_pass = true, .friction = 0.4, .depth = 0.006, .flexible = true, .unilateral = true},
        Options{.friction = 0.01, .depth = 0.006, .flexible = true, .unilateral = true, .sticks = true},
        Options{.friction = 10, .depth = 0.006, .flexible = true, .unilateral = true, .sticks = true},
        Options{.two_pass = true,
                .friction = 0.3,
                .depth = 0.006,
                .flexible = true,
                .unilateral = true,
                .sticks = true},
        Options{.impact = true}, Options{.two_pass = true, .impact = true},
        Options{.basis = model::Basis::full, .impact = true},
        Options{.joint = JointType::free, .rotation = {}, .impact = true},
        Options{.joint = JointType::free, .rotation = {}, .damping = 2, .flexible = true},
        Options{.joint = JointType::spherical, .rotation = {}},
        Options{.joint = JointType::free, .rotation = {}},
        Options{.level = InertiaLevel::full, .joint = JointType::free, .rotation = {}}));

TEST(Contact, solver_inverts_the_matrix_of_bodies_with_residual_flexibility) {
  System system = two_boxes({.damping = 2, .flexible = true});
  LowRankSolver solver(system.solver_bodies());
  solver.set(system.effective_matrix(some_state(system), {3, 20}));
  const VectorXd x = VectorXd::Random(system.size());
  EXPECT_LT((solver.solve(solver.multiply(x)) - x).norm(), 1e-10 * x.norm());
}

TEST(Contact, forces_and_moments_on_both_bodies_balance) {
  System system = two_boxes({.two_pass = true, .damping = 2, .friction = 0.4, .depth = 0.006});
  const Values s = some_state(system);
  const ContactState& contact = system.contacts(kTime, s.U, s.V);
  Eigen::Matrix<double, 6, 2> wrench = Eigen::Matrix<double, 6, 2>::Zero();
  for (int b : {0, 1}) {
    const contact::SurfaceState& surface = contact.surface[b];
    const NodalForces& forces = contact.force[b];
    for (Eigen::Index p = 0; p < forces.f_B.cols(); ++p) {
      const Vector3d x = surface.r_WB + surface.R_WB * forces.x_B.col(p),
                     f = surface.R_WB * forces.f_B.col(p);
      wrench.col(b).head<3>() += f;
      wrench.col(b).tail<3>() += x.cross(f);
    }
  }
  ASSERT_GT(wrench.col(0).head<3>().norm(), 0.1);
  EXPECT_LT((wrench.col(0) + wrench.col(1)).norm(), kRoundoff * wrench.norm());
}

TEST(Contact, snapshot_repeats_the_forces_on_body_b) {
  System system = two_boxes({.two_pass = true});
  const Values s = some_state(system);
  const model::PairState pair = snapshot(system, s).pairs[0];
  const ContactState& contact = system.contacts(kTime, s.U, s.V);
  const contact::SurfaceState& b = contact.surface[1];
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (Eigen::Index p = 0; p < contact.force[1].f_B.cols(); ++p) {
    const Vector3d f = b.R_WB * contact.force[1].f_B.col(p);
    force += f;
    torque += (b.r_WB + b.R_WB * contact.force[1].x_B.col(p)).cross(f);
  }
  EXPECT_LT((pair.force - force).norm(), kRoundoff * force.norm());
  EXPECT_LT((pair.torque - torque).norm(), kRoundoff * torque.norm());
  EXPECT_LT((pair.group_force[0][1] - force).norm(), kRoundoff * force.norm());  // x_max of a
  EXPECT_LT((pair.group_force[1][0] - force).norm(), kRoundoff * force.norm());  // x_min of b
  EXPECT_GT(pair.penetration, 0);
}

TEST(Contact, figures_are_those_of_the_contacts_and_add_up_over_the_areas) {
  for (bool two_pass : {false, true}) {
    System system = two_boxes({.two_pass = two_pass, .damping = 2, .friction = 0.4, .extension = 0});
    const model::PairState pair = snapshot(system, some_state(system)).pairs[0];
    double power = 0, pressure = 0;
    for (const model::ContactRecord& c : pair.contacts) {
      power -= c.f.dot(c.slip);
      pressure = std::max(pressure, c.pressure);
    }
    EXPECT_GT(power, 0);
    EXPECT_NEAR(pair.total.friction_power, power, kRoundoff * power);
    EXPECT_EQ(pair.total.pressure, pressure);
    EXPECT_GT(pair.total.damping_power, 0);
    for (int side : {0, 1}) {
      Vector3d torque = Vector3d::Zero();
      double area = 0;
      int count = 0;
      for (const model::ContactFigures& f : pair.area[side])
        torque += f.torque, count += f.count, area += f.area;
      EXPECT_LT((torque - pair.torque).norm(), kRoundoff * torque.norm());
      EXPECT_EQ(count, pair.count);
      EXPECT_NEAR(area, pair.total.area, kRoundoff);
      EXPECT_LE(area, two_pass ? 2 : 1);  // m^2, of the ends
    }
  }
}

TEST(Contact, slip_does_not_depend_on_who_asks_for_it) {
  System plain = two_boxes({}), rated = two_boxes({.damping = 1e-12});
  const model::PairState a = snapshot(plain, some_state(plain)).pairs[0],
                         b = snapshot(rated, some_state(rated)).pairs[0];
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_GT(a.contacts[i].slip.norm(), 0.01);
    // against the master's surface, or its material carried along over the gap
    EXPECT_LT((a.contacts[i].slip - b.contacts[i].slip).norm(), -10 * a.contacts[i].g_n);
  }
}

TEST(Contact, force_is_minus_the_gradient_of_its_energy) {
  System system = two_boxes({});
  const Values s = some_state(system);
  const VectorXd zero = VectorXd::Zero(system.size());
  const auto energy = [&](const VectorXd& U) {
    return snapshot(system, {kTime, U, zero, zero}).energy.contact;
  };
  const ContactState contact = system.contacts(kTime, s.U, s.V);
  for (std::size_t b : {0u, 1u}) {
    const System::Body& body = system.bodies()[b];
    const body::Force h = contact_force(body.eq, contact.force[b]);
    VectorXd both(h.s.size() + h.q.size());
    both << h.s, h.q;
    for (Eigen::Index j = 0; j < both.size(); ++j) {
      const VectorXd dx = kStep * VectorXd::Unit(system.size(), body.first + j);
      EXPECT_NEAR(both[j], -(energy(s.U + dx) - energy(s.U - dx)) / (2 * kStep), kDifference);
    }
  }
}

TEST(System, refuses_what_cannot_be_simulated) {
  EXPECT_THROW(System({}, {}), Error);
  EXPECT_THROW(System({named("a"), named("a")}, {}), Error);
  EXPECT_THROW(System({named("a")}, {{"a:a", {0, 0}, {}}}), Error);
  EXPECT_THROW(System({named("a")}, {{"a:b", {0, 1}, {}}}), Error);
  BodySetup setup = named("a");
  setup.rotation.load = constant_signal(1);  // on a fixed joint
  EXPECT_THROW(System({setup}, {}), Error);
  setup = named("a");
  setup.joint.r_WB0[1] = NAN;
  EXPECT_THROW(System({setup}, {}), Error);
  setup = named("a");
  setup.joint.R_WB0 *= 2;
  EXPECT_THROW(System({setup}, {}), Error);
  setup = named("a");
  setup.q_dot0 = VectorXd::Zero(2);  // n_q = 3
  EXPECT_THROW(System({setup}, {}), Error);
}

}  // namespace
}  // namespace elastogear::system_test
