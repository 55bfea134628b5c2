// Bodies that nothing holds: Euler's top, the heavy top, and momentum of a deformable body in flight.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

#include "../figures.h"
#include "box_body.h"
#include "elastogear/base/petsc.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::tumbling_test {
using namespace dynamics;
using body::InertiaLevel;
using body::JointType;
using Eigen::Vector3d;

namespace {

constexpr double kOrder = 0.05;  // of a measured order of convergence
constexpr double kDrift = 1e-8;  // relative, over 100 revolutions

std::shared_ptr<model::ElasticBody> rigid(double m, const Vector3d& c, const Vector3d& J) {
  auto body = std::make_shared<model::ElasticBody>();
  body->inertia.m = m;
  body->inertia.c = c;
  body->inertia.J = J.asDiagonal();
  body->inertia.C_l.resize(0, 3);
  body->inertia.C_r.resize(0, 3);
  body->inertia.S_1.resize(9, 0);
  body->M_r.resize(0, 0);
  body->K_r.resize(0, 0);
  body->surface.Phi = model::DenseRows(0, 0);
  return body;
}

// Newton's method to roundoff in every step.
class Tight {
 public:
  Tight() { check(PetscOptionsSetValue(nullptr, "-snes_rtol", "1e-14")); }
  ~Tight() { PetscOptionsClearValue(nullptr, "-snes_rtol"); }
  Tight(const Tight&) = delete;
};

model::Snapshot run(System& system, double dt, double end, const Observer& observer = {}) {
  const Tight tight;
  model::Snapshot last;
  simulate(system, {.dt = dt, .end_time = end}, [&](const model::Snapshot& snapshot) {
    last = snapshot;
    if (observer) observer(snapshot);
  });
  return last;
}

body::Momentum momentum(const System& system, const model::Snapshot& x, std::size_t b = 0) {
  const model::BodyState& s = x.bodies[b];
  return body::momentum(system.bodies()[b].eq, {s.s, s.s_dot, s.s_ddot, s.q, s.q_dot, s.q_ddot});
}

double energy(const model::Snapshot& x) { return x.energy.kinetic + x.energy.elastic; }

// ---- Euler's top

const Vector3d kInertia(1, 2, 3);        // kg m^2
const Vector3d kOmega(0.05, 1.0, 0.05);  // rad/s, nearly about the unstable middle axis

System euler_top(const Vector3d& omega) {
  return System(
      {{.name = "top", .body = rigid(2, {0, 0, 0}, kInertia), .joint = {JointType::free}, .omega0 = omega}},
      {});
}

// Jacobi's sn, cn, dn of u with parameter m, by descending Gauss transformations.
struct Jacobi {
  double sn, cn, dn;
};

Jacobi jacobi(double u, double m) {
  double a[20] = {1}, c[20] = {std::sqrt(m)}, b = std::sqrt(1 - m), power = 1;
  int n = 0;
  for (; std::abs(c[n]) > 1e-16; ++n, power *= 2) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
  }
  double phi = power * a[n] * u;
  for (; n > 0; --n) phi = (std::asin(c[n] * std::sin(phi) / a[n]) + phi) / 2;
  return {std::sin(phi), std::cos(phi), std::sqrt(1 - m * std::sin(phi) * std::sin(phi))};
}

// Landau and Lifshitz, Mechanics, section 37, with J_1 < J_2 < J_3 and L^2 > 2 T J_2; the body starts where
// w_2 = 0 and w_1, w_3 > 0.
Vector3d euler_solution(double T, double L, double t) {
  const double J_1 = kInertia[0], J_2 = kInertia[1], J_3 = kInertia[2], L2 = L * L;
  const double tau = t * std::sqrt((J_3 - J_2) * (L2 - 2 * T * J_1) / (J_1 * J_2 * J_3));
  const double m = (J_2 - J_1) * (2 * T * J_3 - L2) / ((J_3 - J_2) * (L2 - 2 * T * J_1));
  const auto [sn, cn, dn] = jacobi(tau, m);
  return {std::sqrt((2 * T * J_3 - L2) / (J_1 * (J_3 - J_1))) * cn,
          std::sqrt((2 * T * J_3 - L2) / (J_2 * (J_3 - J_2))) * sn,
          std::sqrt((L2 - 2 * T * J_1) / (J_3 * (J_3 - J_1))) * dn};
}

// Largest error of w over some periods, of a motion that passes close to the middle axis.
double euler_error(double dt) {
  const Vector3d start(0.9, 0, 0.53);  // L^2 is 2 % above 2 T J_2
  System system = euler_top(start);
  const double T = 0.5 * start.dot(kInertia.cwiseProduct(start)), L = kInertia.cwiseProduct(start).norm();
  EXPECT_GT(L * L, 2 * T * kInertia[1]);
  double worst = 0;
  run(system, dt, 30, [&](const model::Snapshot& x) {
    const Vector3d w = x.bodies[0].s_dot.tail<3>();
    worst = std::max(worst, (w - euler_solution(T, L, x.time)).norm());
  });
  return worst;
}

// ---- heavy symmetric top

constexpr double kGravity = 9.81, kSpin = 40, kArm = 0.3, kMass = 2, kTilt = 0.5;  // m/s^2, rad/s, m, kg, rad
constexpr double kAcross = 0.25, kAlong = 0.05;                                    // kg m^2, about the tip

// Its tip at the origin, its axis z of the BRF, tilted by kTilt, spinning, its axis at rest.
System heavy_top() {
  body::Joint joint{JointType::spherical};
  joint.R_WB0 = Eigen::AngleAxisd(kTilt, Vector3d::UnitX());
  return System({{.name = "top",
                  .body = rigid(kMass, {0, 0, kArm}, {kAcross, kAcross, kAlong}),
                  .joint = joint,
                  .omega0 = {0, 0, kSpin}}},
                {}, {.gravity = {0, 0, -kGravity}});
}

// Cosine of the axis' tilt (H. Goldstein, Classical Mechanics, section 5.7): u'^2 is a cubic in u.
double nutation(double t) {
  const double a = kAlong * kSpin / kAcross, beta = 2 * kMass * kGravity * kArm / kAcross,
               u_2 = std::cos(kTilt);
  const double root = std::sqrt(std::pow(a, 4) - 4 * beta * (a * a * u_2 - beta));
  const double u_1 = (a * a - root) / (2 * beta), u_3 = (a * a + root) / (2 * beta);
  const auto [sn, cn, dn] = jacobi(0.5 * std::sqrt(beta * (u_3 - u_1)) * t, (u_2 - u_1) / (u_3 - u_1));
  return u_1 + (u_2 - u_1) * cn * cn / (dn * dn);
}

struct TopError {
  double nutation = 0, balance = 0, spin = 0, vertical = 0;  // largest; -, J, rad/s, N m s
};

TopError heavy_top_error(double dt) {
  System system = heavy_top();
  TopError error;
  double L_z = 0;
  run(system, dt, 2, [&](const model::Snapshot& x) {
    const double u = x.bodies[0].R_WB(2, 2), L = momentum(system, x).angular.z();
    if (x.time == 0) L_z = L;
    error.nutation = std::max(error.nutation, std::abs(u - nutation(x.time)));
    error.balance = std::max(error.balance, std::abs(x.energy.balance));
    error.spin = std::max(error.spin, std::abs(x.bodies[0].s_dot[2] - kSpin));
    error.vertical = std::max(error.vertical, std::abs(L - L_z));
  });
  return error;
}

// ---- a deformable body in flight

System flying_box(InertiaLevel level) {
  const test::BoxSpec spec{.corner = {-1, -0.5, -0.25},
                           .size = {2, 1, 0.5},
                           .cells = {3, 2, 1},
                           .material = {200, 0.3, 1},
                           .rigid_modes = 6};
  const auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal, 12));
  return System({{.name = "box",
                  .body = body,
                  .joint = {JointType::free},
                  .velocity0 = {1, 2, 3},
                  .omega0 = {0.3, 1, 0.2},
                  .q_dot0 = 0.3 * Eigen::VectorXd::LinSpaced(12, 1, -1)}},
                {}, {.inertia = level});
}

struct Drift {
  double linear = 0, angular = 0, energy = 0, deformation = 0;  // largest, relative; deformation: of energy
};

Drift flight(InertiaLevel level, double dt) {
  System system = flying_box(level);
  Drift drift;
  body::Momentum p_0;
  double E_0 = 0;
  run(system, dt, 2, [&](const model::Snapshot& x) {
    const body::Momentum p = momentum(system, x);
    if (x.time == 0) {
      p_0 = p;
      E_0 = energy(x);
    }
    drift.linear = std::max(drift.linear, (p.linear - p_0.linear).norm() / p_0.linear.norm());
    drift.angular = std::max(drift.angular, (p.angular - p_0.angular).norm() / p_0.angular.norm());
    drift.energy = std::max(drift.energy, std::abs(energy(x) / E_0 - 1));
    drift.deformation = std::max(drift.deformation, x.energy.elastic / E_0);
  });
  return drift;
}

class FlyingBox : public testing::TestWithParam<InertiaLevel> {};
class LongFlight : public testing::TestWithParam<InertiaLevel> {};

TEST(EulerTop, follows_jacobis_elliptic_functions_with_order_two) {
  const double coarse = euler_error(0.02), fine = euler_error(0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 2, kOrder);
  EXPECT_LT(fine, 1e-3);
  std::cout << "largest error of w at dt = 0.01: " << fine << " rad/s\n";
}

TEST(EulerTop, tumbling_about_its_middle_axis_keeps_momentum_and_energy_over_100_revolutions) {
  System system = euler_top(kOmega);
  const Vector3d L_0 = kInertia.cwiseProduct(kOmega);
  const double T_0 = 0.5 * kOmega.dot(L_0), revolution = 2 * M_PI / kOmega.norm();
  double worst_L = 0, worst_T = 0, turned_over = 1;
  run(system, revolution / 100, 100 * revolution, [&](const model::Snapshot& x) {
    worst_L = std::max(worst_L, (momentum(system, x).angular - L_0).norm() / L_0.norm());
    worst_T = std::max(worst_T, std::abs(x.energy.kinetic / T_0 - 1));
    turned_over = std::min(turned_over, x.bodies[0].s_dot[4]);
  });
  const std::string of = "tumbling rigid body, 100 revolutions";
  test::figure({of, "momentum"}, worst_L, kDrift);
  test::figure({of, "energy"}, worst_T, kDrift);
  EXPECT_LT(turned_over, -0.9);  // it does tumble
}

TEST(HeavyTop, nutates_by_jacobis_elliptic_functions_with_order_two) {
  const TopError coarse = heavy_top_error(0.002), fine = heavy_top_error(0.001);
  EXPECT_NEAR(std::log2(coarse.nutation / fine.nutation), 2, kOrder);
  EXPECT_LT(fine.nutation, 0.03 * (std::cos(kTilt) - nutation(0.15)));
  EXPECT_NEAR(std::log2(coarse.balance / fine.balance), 2, 3 * kOrder);
  EXPECT_LT(fine.spin, 1e-12 * kSpin);
  std::cout << "at dt = 0.001: cos(tilt) " << fine.nutation << ", energy " << fine.balance
            << " J, vertical momentum " << fine.vertical << " N m s\n";
}

TEST(FreeTop, falls_as_a_point_mass_and_precesses_about_its_momentum) {
  const Vector3d J(0.25, 0.25, 0.05), w(3, 0, 40), v(1, 2, 3);
  System system({{.name = "top",
                  .body = rigid(kMass, {0, 0, 0}, J),
                  .joint = {JointType::free},
                  .velocity0 = v,
                  .omega0 = w}},
                {}, {.gravity = {0, 0, -kGravity}});
  constexpr double kTime = 2;
  const model::Snapshot last = run(system, 1e-3, kTime);
  const Vector3d r = kTime * v - kTime * kTime / 2 * Vector3d(0, 0, kGravity);
  EXPECT_LT((last.bodies[0].r_WB - r).norm(), kDrift * r.norm());
  // The axis circles about L with |L| / J_1.
  const Vector3d L = J.cwiseProduct(w);
  const Vector3d axis = Eigen::AngleAxisd(kTime * L.norm() / J[0], L.normalized()) * Vector3d::UnitZ();
  EXPECT_LT((last.bodies[0].R_WB * Vector3d::UnitZ() - axis).norm(), 2e-3);
  EXPECT_NEAR(last.energy.balance, 0, kDrift * energy(last));
}

TEST_P(FlyingBox, keeps_momentum_and_energy_to_second_order) {
  const Drift coarse = flight(GetParam(), 0.01), fine = flight(GetParam(), 0.005);
  EXPECT_LT(fine.linear, kDrift);  // the frame is at the centre of mass: exact
  EXPECT_NEAR(std::log2(coarse.angular / fine.angular), 2, 3 * kOrder);
  EXPECT_NEAR(std::log2(coarse.energy / fine.energy), 2, 3 * kOrder);
  EXPECT_LT(fine.angular, 1e-3);
  EXPECT_LT(fine.energy, 1e-3);
  EXPECT_GT(fine.deformation, 1e-3);  // it takes part
  std::cout << "drift at dt = 0.005: linear " << fine.linear << ", angular " << fine.angular << ", energy "
            << fine.energy << "; elastic share " << fine.deformation << "\n";
}

// No drift: what the steps lose and gain averages out, which the second half of the flight shows.
TEST_P(LongFlight, of_a_vibrating_box_bounds_energy_and_angular_momentum) {
  System system = flying_box(GetParam());
  constexpr double kRevolution = 2 * M_PI / 1.06, kEnd = 20 * kRevolution;
  double E_0 = 0, energy_error[2] = {0, 0}, momentum_error[2] = {0, 0};
  Vector3d L_0;
  run(system, 0.02, kEnd, [&](const model::Snapshot& x) {
    const model::BodyState& s = x.bodies[0];
    const Vector3d p = momentum(system, x).linear, L = momentum(system, x).angular - s.r_WB.cross(p);
    if (x.time == 0) {
      E_0 = energy(x);
      L_0 = L;
    }
    const int half = x.time > kEnd / 2;
    energy_error[half] = std::max(energy_error[half], std::abs(energy(x) / E_0 - 1));
    momentum_error[half] = std::max(momentum_error[half], (L - L_0).norm() / L_0.norm());
  });
  std::cout << "energy " << energy_error[0] << ", " << energy_error[1] << "; momentum " << momentum_error[0]
            << ", " << momentum_error[1] << "\n";
  EXPECT_LT(energy_error[1], 1.5 * energy_error[0]);
  EXPECT_LT(momentum_error[1], 1.5 * momentum_error[0]);
  EXPECT_LT(energy_error[1], 0.01);
}

INSTANTIATE_TEST_SUITE_P(Levels, FlyingBox,
                         testing::Values(InertiaLevel::linear, InertiaLevel::affine, InertiaLevel::full));
INSTANTIATE_TEST_SUITE_P(Levels, LongFlight,
                         testing::Values(InertiaLevel::linear, InertiaLevel::affine, InertiaLevel::full));

}  // namespace
}  // namespace elastogear::tumbling_test
