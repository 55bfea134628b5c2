// Loads and bushings at markers: force laws, and the tangent of a system that has all of them.
#include "elastogear/dynamics/marker_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "box_body.h"
#include "dynamics/run/snapshot.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/dynamics/system.h"
#include "markers.h"

namespace elastogear::marker_forces_test {
using namespace dynamics;
using body::JointType;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kStep = 1e-6;        // of central differences, against sizes of order one
constexpr double kDifference = 1e-7;  // relative: roundoff / kStep, and kStep^2 curvature
constexpr double kRoundoff = 1e-12;
constexpr double kTime = 0.3;

const Vector3d kSprings(3, 5, 2);

// Aligned, by less and by more than the series serves, far, and turned more than once around.
std::vector<Matrix3d> some_rotations() {
  return {Matrix3d::Identity(),
          rotation_matrix({1e-3, -2e-3, 0}),
          rotation_matrix({0.199, 0, 0}),
          rotation_matrix({0.201, 0, 0}),
          rotation_matrix({0.7, -0.5, 0.4}),
          rotation_matrix({0.3, 0.2, 0}) * rotation_matrix({0, 0, 2.9}),
          rotation_matrix({2, 1.5, 0})};
}

TEST(TiltAndTurn, torque_is_minus_the_gradient_of_the_energy) {
  for (const Matrix3d& R : some_rotations()) {
    const TiltAndTurn at = tilt_and_turn(kSprings, R);
    for (int i = 0; i < 3; ++i) {
      const Vector3d h = kStep * Vector3d::Unit(i);
      const TiltAndTurn plus = tilt_and_turn(kSprings, rotation_matrix(h) * R),
                        minus = tilt_and_turn(kSprings, rotation_matrix(-h) * R);
      EXPECT_NEAR(at.torque[i], -(plus.energy - minus.energy) / (2 * kStep), kDifference * 10);
      EXPECT_LT((at.derivative.col(i) - (plus.torque - minus.torque) / (2 * kStep)).norm(), kDifference * 10);
    }
  }
}

TEST(TiltAndTurn, angles_make_the_rotation) {
  for (const Matrix3d& R : some_rotations()) {
    const Vector3d angle = tilt_and_turn(kSprings, R).angle;
    EXPECT_LT((rotation_matrix({angle[0], angle[1], 0}) * rotation_matrix({0, 0, angle[2]}) - R).norm(),
              kRoundoff);
  }
}

TEST(TiltAndTurn, tilt_does_not_feel_the_turn) {
  const Matrix3d tilt = rotation_matrix({0.1, -0.2, 0});
  const Vector3d loose(3, 5, 0);
  const Vector3d torque = tilt_and_turn(loose, tilt).torque;
  for (double turn : {0.5, 2.0, 3.1, 4.5})
    EXPECT_LT((tilt_and_turn(loose, tilt * rotation_matrix({0, 0, turn})).torque - torque).norm(), kRoundoff);
}

std::shared_ptr<const model::ElasticBody> box(const Vector3d& corner, model::Basis basis, int n_modes) {
  auto body = test::make_damped_box(corner, {2, 1, 1}, basis, n_modes);
  test::add_end_markers(*body);
  return body;
}

BushingSetup bushing(const MarkerName& first, const MarkerName& second, bool axes_of_first) {
  BushingSetup setup{first.body + "-" + second.body, {first, second}};
  setup.law = {{20, 30, 40}, {7, 5, 3}, {2, 3, 1}, {0.5, 0.2, 0.4}};
  setup.axes = rotation_matrix({0.3, -0.5, 0.7});
  setup.axes_of_first = axes_of_first;
  return setup;
}

// Linear in the motion, so that its differences are its derivative.
body::Wrench spring_and_damper(double t, const body::MarkerMotion& m) {
  body::Wrench wrench;
  wrench << -20 * m.x - 3 * m.v + Vector3d(t, 0, 1), -2 * m.w + 5 * m.v.cross(Vector3d::UnitX());
  return wrench;
}

MarkerSetups all_kinds() {
  MarkerSetups setups;
  const MarkerName a{"a", "x_max"}, b{"b", "x_min"}, frame{"b", "frame"}, ground;
  setups.loads = {{"world", a, {1, -2, 3}, {0.5, 0.7, -0.3}, false, ramp_signal(2, 1)},
                  {"follower", b, {-1, 2, 1}, {0.3, -0.6, 0.4}, true, constant_signal(1.5)},
                  {"on_frame", frame, {0, 1, 2}, {1, 0, 1}, true, constant_signal(1)}};
  setups.loads.push_back({.name = "computed", .marker = b, .law = spring_and_damper});
  setups.bushings = {bushing(a, b, true), bushing(ground, frame, false), bushing(a, ground, false)};
  return setups;
}

struct Options {
  JointType a = JointType::free, b = JointType::revolute;
  model::Basis basis = model::Basis::modal;
  body::InertiaLevel level = body::InertiaLevel::linear;
};

System two_boxes(const Options& options, const MarkerSetups& setups) {
  std::vector<BodySetup> bodies(2);
  bodies[0] = {.name = "a",
               .body = box({0, -0.5, -0.5}, options.basis, 14),
               .joint = {.type = options.a, .axis = {0, 0.2, 1}, .point = {0.1, 0.2, -0.3}}};
  bodies[1] = {.name = "b",
               .body = box({-2, -0.5, -0.5}, options.basis, 15),
               .joint = {options.b, {1, 3, -1}, {5, 0.3, 0.4}, rotation_matrix({0.2, 0.5, -0.1})}};
  return System(bodies, {}, {.inertia = options.level, .gravity = {1, -2, 3}}, setups);
}

struct Values {
  VectorXd U, V, A;
  operator State() const { return {kTime, U, V, A}; }
};

Values some_state(const System& system) {
  std::srand(4);
  return {system.initial_position() + 0.2 * VectorXd::Random(system.size()), VectorXd::Random(system.size()),
          VectorXd::Random(system.size())};
}

// dF along (x, shift_v x, shift_a x)
VectorXd difference(System& system, const Values& s, const VectorXd& x, const body::Shifts& shift) {
  const auto F = [&](double h) {
    const VectorXd dx = h * x;
    return system.residual(Values{s.U + dx, s.V + shift.v * dx, s.A + shift.a * dx}).F;
  };
  return (F(kStep) - F(-kStep)) / (2 * kStep);
}

class Tangent : public testing::TestWithParam<Options> {};

TEST_P(Tangent, of_all_forces_at_markers_is_the_derivative_of_the_residual) {
  System system = two_boxes(GetParam(), all_kinds());
  const body::Shifts shift{3, 20};
  const Values s = some_state(system);
  LowRankSolver solver(system.solver_bodies());
  solver.set(system.effective_matrix(s, shift));
  for (Eigen::Index j = 0; j < system.size(); ++j) {
    const VectorXd unit = VectorXd::Unit(system.size(), j), column = solver.multiply(unit);
    EXPECT_LT((column - difference(system, s, unit, shift)).norm(), kDifference * column.norm())
        << "column " << j;
    if (!system.solver_is_exact()) continue;
    EXPECT_LT((solver.solve(column) - unit).norm(), kRoundoff * 1e3) << "column " << j;  // its condition
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, Tangent,
                         testing::Values(Options{}, Options{.a = JointType::spherical, .b = JointType::fixed},
                                         Options{.a = JointType::cylindrical, .b = JointType::free},
                                         Options{.basis = model::Basis::full},
                                         Options{.level = body::InertiaLevel::constant},
                                         Options{.level = body::InertiaLevel::affine},
                                         Options{.level = body::InertiaLevel::full}));

TEST(Bushing, is_unloaded_at_the_start_wherever_its_markers_are) {
  System system = two_boxes({}, all_kinds());
  const VectorXd zero = VectorXd::Zero(system.size());
  for (const auto& state : snapshot(system, {0, system.initial_position(), zero, zero}).bushings) {
    EXPECT_LT(state.force.norm(), kRoundoff * 40);
    EXPECT_LT(state.torque.norm(), kRoundoff * 7);
  }
}

TEST(Bushing, forces_and_moments_on_both_bodies_balance) {
  const body::MarkerMotion first{
      .x = {1, 2, 3}, .R = rotation_matrix({0.1, 0.2, 0.3}), .v = {1, 0, 2}, .w = {0, 1, 1}},
      second{.x = {1.3, 2.2, 2.5}, .R = rotation_matrix({-0.4, 0.5, 0.3}), .v = {0, 2, 1}, .w = {1, -1, 2}};
  const Bushing b = make_bushing({{2, 3, 4}, {5, 6, 7}, {1, 2, 3}, {2, 1, 3}}, Matrix3d::Identity(), {}, {});
  const BushingForce state = dynamics::bushing_force(b, first, second);
  const body::Wrench on_1 = state.on_first(second.x - first.x), on_2 = state.on_second();
  const Vector3d moment =
      on_1.tail<3>() + first.x.cross(on_1.head<3>()) + on_2.tail<3>() + second.x.cross(on_2.head<3>());
  EXPECT_LT((on_1 + on_2).head<3>().norm(), kRoundoff * on_2.norm());
  EXPECT_LT(moment.norm(), kRoundoff * on_2.norm() * 10);
}

TEST(MarkerForces, refuses_names_and_values_that_make_no_sense) {
  const auto refused = [](const MarkerSetups& setups) { EXPECT_THROW(two_boxes({}, setups), Error); };
  refused({.loads = {{"l", {"c", "x_max"}}}});
  refused({.loads = {{"l", {"a", "nowhere"}}}});
  refused({.loads = {{"l", {}}}});
  refused({.loads = {{"l", {"a", "x_max"}}, {"l", {"b", "x_max"}}}});
  refused({.loads = {{"l", {"a", "x_max"}, {NAN, 0, 0}}}});
  refused({.sensors = {{"s", {}}}});
  System infinite =
      two_boxes({}, {.loads = {{.name = "l", .marker = {"a", "x_max"}, .law = [](double, const auto&) {
                                  return body::Wrench(body::Wrench::Constant(INFINITY));
                                }}}});
  EXPECT_THROW(infinite.residual(some_state(infinite)), Error);
  BushingSetup both = bushing({"a", "frame"}, {"a", "frame"}, false);
  refused({.bushings = {both}});
  refused({.bushings = {bushing({}, {}, false)}});
  BushingSetup negative = bushing({}, {"a", "x_max"}, false);
  negative.law.c[1] = -1;
  refused({.bushings = {negative}});
}

TEST(MarkerForces, refuse_torques_on_a_marker_without_rotation) {
  auto body = std::make_shared<model::ElasticBody>(*box({0, 0, 0}, model::Basis::modal, 14));
  body->markers[0].turns = false;
  const std::vector<BodySetup> bodies = {{.name = "a", .body = body}};
  const MarkerName line{"a", "x_min"};
  EXPECT_NO_THROW(System(bodies, {}, {}, {.loads = {{"l", line, {1, 0, 0}}}}));
  EXPECT_THROW(System(bodies, {}, {}, {.loads = {{"l", line, {1, 0, 0}, {0, 0, 1}}}}), Error);
  EXPECT_THROW(System(bodies, {}, {}, {.loads = {{"l", line, {1, 0, 0}, {0, 0, 0}, true}}}), Error);
  EXPECT_THROW(System(bodies, {}, {}, {.bushings = {bushing({}, line, false)}}), Error);
}

}  // namespace
}  // namespace elastogear::marker_forces_test
