// Shafts on bushings, follower forces and sensors against closed form solutions and conservation laws.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "../fem/brick.h"
#include "box_body.h"
#include "dynamics/run/snapshot.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/rotation.h"
#include "elastogear/body/rigid.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/dynamics/static.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"
#include "markers.h"

namespace elastogear::bushing_test {
using namespace dynamics;
using body::JointType;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kNewton = 1e-9;  // relative, of a converged equilibrium
constexpr double kBeam = 5e-3;    // relative: beam theory against solid elements of this size
constexpr double kSnes = 1e-7;    // relative, of the static analysis' own equilibria
constexpr double kOrder = 0.1;    // of a measured order of convergence

// Newton's method for F(0, U, 0, 0) = 0 from the initial position.
VectorXd equilibrium(System& system) {
  VectorXd U = system.initial_position();
  const VectorXd zero = VectorXd::Zero(U.size());
  LowRankSolver solver(system.solver_bodies());
  for (int i = 0; i < 20; ++i) {
    solver.set(system.effective_matrix({0, U, zero, zero}, {0, 0}));
    U -= solver.solve(system.residual({0, U, zero, zero}).F);
  }
  return U;
}

model::Snapshot state_at(System& system, const VectorXd& U) {
  const VectorXd zero = VectorXd::Zero(U.size());
  return snapshot(system, {0, U, zero, zero});
}

model::Marker point(const std::string& name, const Vector3d& X, Eigen::Index n_q) {
  return {name, X, true, model::DenseRows::Zero(6, n_q)};
}

std::shared_ptr<model::ElasticBody> rigid_shaft(double m) {
  auto body = std::make_shared<model::ElasticBody>(
      body::rigid_body(m, Vector3d::Zero(), Vector3d(0.1, 2, 2).asDiagonal()));
  body->markers = {point("left", {-1, 0, 0}, 0), point("right", {1, 0, 0}, 0), point("load", {0.5, 0, 0}, 0)};
  return body;
}

BushingSetup spring(const std::string& name, const MarkerName& a, const MarkerName& b,
                    const BushingLaw& law) {
  BushingSetup setup{name, {a, b}};
  setup.law = law;
  return setup;
}

BushingLaw stiffness(double k) { return {Vector3d::Constant(k), Vector3d::Zero()}; }

constexpr double kSpring = 1e6, kForce = 100;

// ---- static deflection

TEST(Bushing, carries_a_rigid_shaft_by_the_lever_rule) {
  MarkerSetups setups;
  // Along the shaft only the left one holds; about it a rotational spring.
  setups.bushings = {spring("left", {}, {"shaft", "left"}, stiffness(kSpring)),
                     spring("right", {"shaft", "right"}, {}, {{0, kSpring, kSpring}, Vector3d::Zero()})};
  // The axis of free turning is the shaft's.
  setups.bushings[0].axes = rotation_matrix({0, std::numbers::pi / 2, 0});
  setups.bushings[0].law.k_r = {0, 0, 50};
  setups.loads = {{"push", {"shaft", "load"}, {0, 0, kForce}},
                  {"twist", {"shaft", "frame"}, {0, 0, 0}, {0.2, 0, 0}}};
  System system({{.name = "shaft", .body = rigid_shaft(3), .joint = {JointType::free}}}, {}, {}, setups);
  const VectorXd U = equilibrium(system);
  const auto bushings = state_at(system, U).bushings;
  EXPECT_NEAR(bushings[0].force.z(), -kForce / 4, kNewton * kForce);
  EXPECT_NEAR(bushings[1].force.z(), 3 * kForce / 4, kNewton * kForce);  // on the ground
  const double left = kForce / 4 / kSpring, right = 3 * kForce / 4 / kSpring;
  // The tilt makes the ends come nearer by its square, which the springs feel.
  const double second_order = std::pow(left + right, 2);
  EXPECT_NEAR(U[2], (left + right) / 2, second_order);
  EXPECT_NEAR(U[3], 0.2 / 50, second_order + std::pow(0.2 / 50, 3));
  EXPECT_NEAR(U[4], -(right - left) / 2, second_order);
}

// A bar of one cell across and nu = 0 is exact: springs k, E A / L, k in series and parallel.
TEST(Bushing, and_an_elastic_bar_are_springs_in_series) {
  const test::BoxSpec spec{
      .size = {2, 0.1, 0.1}, .cells = {4, 1, 1}, .material = {1e8, 0, 1000}, .rigid_modes = 6};
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal));
  test::add_end_markers(*body);
  constexpr double kBar = 1e8 * 0.01 / 2, kFirst = 2e5, kSecond = 3e5;
  const Vector3d hold(1e9, 1e9, 1e9);  // against turning
  MarkerSetups setups;
  setups.bushings = {spring("first", {"bar", "x_min"}, {}, {Vector3d::Constant(kFirst), hold}),
                     spring("second", {}, {"bar", "x_max"}, {{kSecond, 0, 0}, Vector3d::Zero()})};
  setups.loads = {{"pull", {"bar", "x_max"}, {kForce, 0, 0}}};
  setups.sensors = {{"end", {"bar", "x_max"}}};
  System system({{.name = "bar", .body = body, .joint = {JointType::free}}}, {}, {}, setups);
  const model::Snapshot last = state_at(system, equilibrium(system));
  const double deflection = kForce / (kSecond + 1 / (1 / kFirst + 1 / kBar));
  EXPECT_NEAR(last.sensors[0].position.x() - 2, deflection, kNewton * deflection);
  const double stored = last.energy.elastic + last.energy.bushing;
  EXPECT_NEAR(stored, kForce * deflection / 2, kNewton * stored);  // Clapeyron
}

// Length 1, square of 0.05, supported at the middle of its ends, loaded in the middle.
TEST(Bushing, carries_an_elastic_shaft_as_beam_theory_says) {
  auto mesh = test::brick({40, 2, 2}, {1, 0.05, 0.05});
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (std::abs(mesh.X(0, i) - 0.5) < 1e-9) mesh.node_sets["middle"].push_back(i);
  const std::string path = (std::filesystem::temp_directory_path() / "bushing_shaft.h5").string();
  const model::Material steel{210e9, 0.3, 7850};
  reduction::ReductionOptions options{.name = "shaft", .regions = {{"", steel}}, .floating = true};
  options.frame_at_center = true;
  options.markers = {"xmin", "xmax", "middle"};
  options.n_modes = 60;
  options.completeness = false;
  options.store = reduction::Store::surface;
  reduction::reduce(PETSC_COMM_SELF, mesh, options, path);
  const auto body = std::make_shared<model::ElasticBody>(io::read_body(path));
  std::filesystem::remove(path);
  MarkerSetups setups;
  setups.bushings = {spring("left", {}, {"shaft", "xmin"}, {Vector3d::Constant(1e7), {1, 0, 0}}),
                     spring("right", {}, {"shaft", "xmax"}, {{0, 1e7, 1e7}, {1, 0, 0}})};
  setups.loads = {{"push", {"shaft", "middle"}, {0, 0, kForce}}};
  setups.sensors = {{"middle", {"shaft", "middle"}}};
  System system({{.name = "shaft", .body = body, .joint = {JointType::free}}}, {}, {}, setups);
  const double z = state_at(system, equilibrium(system)).sensors[0].position.z();
  const double A = 0.05 * 0.05, I = A * A / 12, G = steel.E / (2 * (1 + steel.nu));
  const double deflection = kForce * (1 / (48 * steel.E * I) + 1 / (4 * G * A * 5 / 6) + 1 / (2 * 1e7));
  EXPECT_NEAR(z, deflection, kBeam * deflection);
}

// ---- motion

// Newton's method to roundoff in every step.
class Tight {
 public:
  Tight() { check(PetscOptionsSetValue(nullptr, "-snes_rtol", "1e-12")); }
  ~Tight() { PetscOptionsClearValue(nullptr, "-snes_rtol"); }
  Tight(const Tight&) = delete;
};

RunSummary run(System system, double dt, double end, const Observer& observer) {
  const Tight tight;
  return simulate(system, {.dt = dt, .end_time = end}, observer);
}

std::shared_ptr<model::ElasticBody> soft_box() {
  const test::BoxSpec spec{.corner = {-1, -0.5, -0.5},
                           .size = {2, 1, 1},
                           .cells = {2, 1, 1},
                           .material = {100, 0.3, 1},
                           .rigid_modes = 6};
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal, 8));
  test::add_end_markers(*body);
  return body;
}

// Two free boxes, thrown, joined end to end.
System pair_in_flight(const Vector3d& damping) {
  BushingSetup joint =
      spring("joint", {"a", "x_max"}, {"b", "x_min"}, {{20, 30, 25}, {3, 4, 5}, damping, damping / 4});
  joint.axes = rotation_matrix({0.2, 0.3, -0.4});
  return System({{.name = "a",
                  .body = soft_box(),
                  .joint = {JointType::free},
                  .velocity0 = {0.3, 0, 0.1},
                  .omega0 = {0.2, 0.6, 0.1}},
                 {.name = "b",
                  .body = soft_box(),
                  .joint = {.type = JointType::free, .r_WB0 = {2.2, 0, 0}},
                  .omega0 = {-0.3, 0.1, 0.5}}},
                {}, {}, {.bushings = {joint}});
}

body::Momentum momentum(const System& system, const model::Snapshot& x) {
  body::Momentum total{Vector3d::Zero(), Vector3d::Zero()};
  for (std::size_t b = 0; b < x.bodies.size(); ++b) {
    const model::BodyState& s = x.bodies[b];
    const body::Momentum own =
        body::momentum(system.bodies()[b].eq, {s.s, s.s_dot, s.s_ddot, s.q, s.q_dot, s.q_ddot});
    total.linear += own.linear;
    total.angular += own.angular;
  }
  return total;
}

struct Drift {
  double linear = 0, angular = 0, imbalance = 0, stored = 0, dissipated = 0;
};

Drift drift(const Vector3d& damping, double dt) {
  System system = pair_in_flight(damping);
  std::optional<body::Momentum> start;
  Drift drift;
  const Observer look = [&](const model::Snapshot& x) {
    const body::Momentum now = momentum(system, x);
    if (!start) start = now;
    drift.linear = std::max(drift.linear, (now.linear - start->linear).norm());
    drift.angular = std::max(drift.angular, (now.angular - start->angular).norm());
    drift.stored = std::max(drift.stored, x.energy.bushing);
    drift.dissipated = x.energy.dissipated;
  };
  const Tight tight;
  // The local rotation vectors are re-based in `system` itself, which `look` reads.
  drift.imbalance = simulate(system, {.dt = dt, .end_time = 2}, look).largest_imbalance;
  return drift;
}

TEST(Bushing, between_free_bodies_conserves_momentum_and_energy_at_order_two) {
  for (const Vector3d& damping : {Vector3d(0, 0, 0), Vector3d(0.5, 0.3, 0.4)}) {
    const Drift coarse = drift(damping, 0.02), fine = drift(damping, 0.01);
    EXPECT_LT(coarse.linear, 1e-3);
    EXPECT_NEAR(std::log2(coarse.angular / fine.angular), 2, kOrder * 2);
    EXPECT_NEAR(std::log2(coarse.imbalance / fine.imbalance), 2, kOrder * 2);
    EXPECT_GT(fine.stored, 1e-2);  // J: it takes part
    EXPECT_LT(fine.imbalance, 1e-2 * fine.stored);
    EXPECT_GE(fine.dissipated, damping.isZero() ? 0 : 0.1 * fine.stored);
  }
}

TEST(Bushing, damps_an_oscillator_as_the_closed_form_says) {
  constexpr double kMass = 3, kStiff = 300, kDamper = 2, kEnd = 1.3;
  MarkerSetups setups;
  setups.bushings = {
      spring("spring", {}, {"mass", "frame"},
             {Vector3d::Constant(kStiff), Vector3d::Constant(10), Vector3d::Constant(kDamper)})};
  setups.sensors = {{"mass", {"mass", "frame"}}};
  const auto position = [&](double dt) {
    model::Snapshot last;
    run(System({{.name = "mass",
                 .body = rigid_shaft(kMass),
                 .joint = {JointType::free},
                 .velocity0 = {0, 1, 0}}},
               {}, {}, setups),
        dt, kEnd, [&](const model::Snapshot& x) { last = x; });
    return last.sensors[0].position.y();
  };
  const double delta = kDamper / (2 * kMass), omega = std::sqrt(kStiff / kMass - delta * delta);
  const double exact = std::exp(-delta * kEnd) * std::sin(omega * kEnd) / omega;
  const double coarse = std::abs(position(0.01) - exact), fine = std::abs(position(0.005) - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 2, kOrder);
  EXPECT_LT(fine, std::pow(omega * 0.005, 2) * kEnd / 12);  // the midpoint rule's error of the phase
}

// A constant force that turns with a body in steady rotation: x'' = F/m (cos wt, sin wt).
TEST(Load, that_follows_a_turning_body_drives_it_on_a_circle_that_drifts) {
  constexpr double kOmega = 3, kMass = 2, kEnd = 1;
  const auto error = [&](double dt) {
    MarkerSetups setups;
    setups.loads = {{"thrust", {"top", "frame"}, {5, 0, 0}, {0, 0, 0}, true}};
    double largest = 0;
    const Vector3d spin(0, 0, kOmega);
    run(System({{.name = "top", .body = rigid_shaft(kMass), .joint = {JointType::free}, .omega0 = spin}}, {},
               {}, setups),
        dt, kEnd, [&](const model::Snapshot& x) {
          const double a = 5 / (kMass * kOmega * kOmega), t = x.time;
          const Vector3d exact(a * (1 - std::cos(kOmega * t)), a * (kOmega * t - std::sin(kOmega * t)), 0);
          largest = std::max(largest, (x.bodies[0].r_WB - exact).norm());
        });
    return largest;
  };
  const double coarse = error(0.02), fine = error(0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 2, kOrder);
  EXPECT_LT(fine, 1e-3);
}

TEST(Load, work_is_booked) {
  MarkerSetups setups;
  setups.loads = {{"push", {"box", "x_max"}, {1, 2, 0}, {0.3, 0, 0.5}, false, ramp_signal(1, 0.5)},
                  {"follow", {"box", "x_min"}, {0, 1, -1}, {0, 0.4, 0}, true}};
  const auto imbalance = [&](double dt) {
    return run(System({{.name = "box", .body = soft_box(), .joint = {JointType::free}}}, {}, {}, setups), dt,
               1, {});
  };
  const RunSummary coarse = imbalance(0.02), fine = imbalance(0.01);
  EXPECT_NEAR(std::log2(coarse.largest_imbalance / fine.largest_imbalance), 2, 2 * kOrder);
}

TEST(Load, table_must_cover_the_run) {
  MarkerSetups setups;
  setups.loads = {{"push", {"box", "frame"}, {1, 0, 0}, {0, 0, 0}, false, table_signal({0, 0.5}, {1, 1})}};
  System system({{.name = "box", .body = rigid_shaft(1), .joint = {JointType::free}}}, {}, {}, setups);
  EXPECT_THROW(simulate(system, {.dt = 0.1, .end_time = 1}, {}), Error);
}

TEST(Load, grows_with_the_load_factor_of_a_static_analysis) {
  MarkerSetups setups;
  const BushingLaw half = {Vector3d::Constant(kSpring / 2), Vector3d::Constant(10)};
  setups.bushings = {spring("left", {}, {"shaft", "left"}, half),
                     spring("right", {}, {"shaft", "right"}, half)};
  setups.loads = {{"push", {"shaft", "frame"}, {0, kForce, 0}, {0, 0, 0}, false, ramp_signal(2, 0.5)}};
  scale_by_load_factor(setups, 0.25);  // where the ramp is at 1
  System system({{.name = "shaft", .body = rigid_shaft(1), .joint = {JointType::free}}}, {}, {}, setups);
  int n = 0;
  solve_static(system, {4}, [&](const model::Snapshot& x) {
    const double expected = x.time * kForce / kSpring;
    EXPECT_NEAR(x.bodies[0].r_WB.y(), expected, kSnes * expected);
    EXPECT_NEAR(x.bushings[0].force.y(), -x.time * kForce / 2, kSnes * kForce);
    ++n;
  });
  EXPECT_EQ(n, 5);
}

// ---- sensors

TEST(Sensor, velocity_and_acceleration_are_derivatives_of_the_position) {
  constexpr double kDt = 1e-3;
  MarkerSetups setups;
  setups.sensors = {{"tip", {"box", "x_max"}}};
  setups.loads = {{"push", {"box", "x_min"}, {1, -2, 3}, {0.5, 0.2, 0.1}}};
  std::vector<model::SensorState> tip;
  run(System({{.name = "box", .body = soft_box(), .joint = {JointType::free}, .omega0 = {1, 2, -1}}}, {}, {},
             setups),
      kDt, 0.1, [&](const model::Snapshot& x) { tip.push_back(x.sensors[0]); });
  double scale_v = 0, scale_a = 0, scale_w = 0, error_v = 0, error_a = 0, error_w = 0;
  for (std::size_t i = 1; i + 1 < tip.size(); ++i) {
    const Vector3d v = (tip[i + 1].position - tip[i - 1].position) / (2 * kDt),
                   a = (tip[i + 1].velocity - tip[i - 1].velocity) / (2 * kDt);
    const Matrix3d W = (tip[i + 1].rotation - tip[i - 1].rotation) / (2 * kDt) * tip[i].rotation.transpose();
    error_v = std::max(error_v, (v - tip[i].velocity).norm());
    error_a = std::max(error_a, (a - tip[i].acceleration).norm());
    error_w = std::max(error_w, (W - skew(tip[i].angular_velocity)).norm());
    scale_v = std::max(scale_v, v.norm());
    scale_a = std::max(scale_a, a.norm());
    scale_w = std::max(scale_w, W.norm());
  }
  constexpr double kDifference = 5e-3;  // (omega dt)^2 of the highest mode, about 30 rad/s, and of the spin
  EXPECT_LT(error_v, kDifference * scale_v);
  EXPECT_LT(error_a, kDifference * scale_a);
  EXPECT_LT(error_w, kDifference * scale_w);
}

// ---- damping ratios

TEST(DampingRatio, makes_every_mode_decay_by_it) {
  auto body = soft_box();
  body->zeta = VectorXd::LinSpaced(8, 0.01, 0.08);
  constexpr double kDt = 2e-4, kEnd = 0.2, kRate = 0.1;
  model::Snapshot last;
  run(System({{.name = "box", .body = body, .q_dot0 = kRate * VectorXd::Ones(8)}}, {}), kDt, kEnd,
      [&](const model::Snapshot& x) { last = x; });
  for (int i = 0; i < 8; ++i) {
    const double omega = 2 * std::numbers::pi * body->frequency[i], zeta = body->zeta[i];
    const double omega_d = omega * std::sqrt(1 - zeta * zeta);
    const double exact = kRate * std::exp(-zeta * omega * kEnd) * std::sin(omega_d * kEnd) / omega_d;
    EXPECT_NEAR(last.bodies[0].q[i], exact, kRate * std::pow(omega * kDt, 2) * kEnd) << i;  // of order two
  }
}

}  // namespace
}  // namespace elastogear::bushing_test
