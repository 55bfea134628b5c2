// Viscoelastic rods, E(t) = E_0 (1 - g (1 - exp(-t/tau))), against closed forms.

#include "elastogear/body/relaxation.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "../figures.h"
#include "../message_of.h"
#include "box_body.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/dynamics/static.h"
#include "markers.h"

namespace elastogear::relaxation_test {
using namespace dynamics;
using Eigen::Vector3d;

namespace {

constexpr double kArea = 0.01, kLength = 1;          // m^2, m
constexpr double kE = 2e6;                           // Pa
constexpr double kStiffness = kE * kArea / kLength;  // N/m, of the rod
constexpr double kClosedForm = 1e-3;                 // relative

struct Series {
  std::vector<double> g, tau;
};

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

// A rod along x without Poisson's effect, clamped at x = 0, with markers at its ends. wave: s, that a wave
// takes from end to end.
std::shared_ptr<model::ElasticBody> rod(const Series& series, double wave, model::Basis basis, int cells = 2,
                                        int n_modes = 0) {
  test::BoxSpec spec{.size = {kLength, 0.1, 0.1},
                     .cells = {cells, 1, 1},
                     .material = {kE, 0, kE * wave * wave / (kLength * kLength)}};
  spec.held = [](const Vector3d& X, int direction) { return direction != 0 || X.x() == 0; };
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, basis, n_modes));
  test::add_end_markers(*body);
  if (!series.g.empty())
    body->relaxing = {{"", model::ModulusPart::both, vector_of(series.g), vector_of(series.tau), body->K_r}};
  return body;
}

double tip(const model::ElasticBody& body, const model::Snapshot& s, int direction = 0) {
  return model::multiply(body.markers[1].Phi, s.bodies[0].q)[direction];
}

struct Point {
  double t, x;
};

using Load = std::function<double(double)>;

// Displacement of the end under a load in this direction.
std::vector<Point> pulled(const std::shared_ptr<model::ElasticBody>& body, const TimeSettings& time,
                          const Load& load, std::vector<model::Energies>* energy = nullptr,
                          int direction = 0) {
  MarkerSetups markers;
  markers.loads = {{"pull", {"rod", "x_max"}}};
  markers.loads[0].law = [load, direction](double t, const body::MarkerMotion&) {
    body::Wrench wrench = body::Wrench::Zero();
    wrench[direction] = load(t);
    return wrench;
  };
  System system({{.name = "rod", .body = body}}, {}, {}, markers);
  std::vector<Point> points;
  simulate(system, time, [&](const model::Snapshot& s) {
    points.push_back({s.time, tip(*body, s, direction)});
    if (energy) energy->push_back(s.energy);
  });
  return points;
}

// Creep compliance of one term over the time since loading, 1/k_0.
double creep(double g, double tau, double t) {
  const double relaxed = 1 / (1 - g);
  return relaxed - (relaxed - 1) * std::exp(-t * (1 - g) / tau);
}

// Its integral from 0 to t.
double creep_integral(double g, double tau, double t) {
  const double relaxed = 1 / (1 - g), time = tau / (1 - g);
  return relaxed * t - (relaxed - 1) * time * (1 - std::exp(-t / time));
}

// A load that is put on within `rise` stays: its creep from a time of 1e-7 s to one of 1e5 s.
TEST(Rod, creeps_under_load_over_twelve_decades) {
  const double g = 0.6, force = 3;
  for (model::Basis basis : {model::Basis::modal, model::Basis::full})
    for (double tau : {1e-7, 1e-3, 1.0, 1e5}) {
      const double rise = 0.3 * tau;
      const TimeSettings time{.dt = tau / 100, .end_time = 6 * tau, .rho_inf = 0};
      const auto found = pulled(rod({{g}, {tau}}, 1e-4 * tau, basis), time,
                                [&](double t) { return force * std::min(1.0, t / rise); });
      ASSERT_EQ(found.size(), 601u);
      double worst = 0;
      for (const auto& [t, x] : found) {
        const double late = std::max(0.0, t - rise);
        const double exact =
            force / kStiffness / rise * (creep_integral(g, tau, t) - creep_integral(g, tau, late));
        worst = std::max(worst, std::abs(x - exact));
      }
      test::figure({"creep of a rod", "displacement"}, worst * kStiffness / force, kClosedForm);
      std::printf("creep, time of %g s: largest error %.1e of the elastic displacement\n", tau,
                  worst * kStiffness / force);
      EXPECT_NEAR(found.back().x * kStiffness / force, creep(g, tau, 6 * tau), 0.05);
    }
}

// A cantilever of three dimensions with a constant Poisson's ratio: its elastic deflection times the creep
// compliance.
TEST(Cantilever, creeps_by_its_elastic_deflection_times_the_creep_compliance) {
  constexpr int kDown = 2;
  const double g = 0.6, tau = 10, rise = 3, force = -2;
  test::BoxSpec spec{.size = {1, 0.1, 0.1}, .cells = {8, 1, 1}, .material = {kE, 0.3, 1e-3}};
  spec.held = [](const Vector3d& X, int) { return X.x() == 0; };
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::full));
  test::add_end_markers(*body);
  const auto load = [&](double t) { return force * std::min(1.0, t / rise); };
  const TimeSettings time{.dt = 0.1, .end_time = 40, .rho_inf = 0};
  const double elastic = pulled(body, time, load, nullptr, kDown).back().x;
  body->relaxing = {{"", model::ModulusPart::both, vector_of({g}), vector_of({tau}), body->K_r}};
  double worst = 0;
  for (const auto& [t, x] : pulled(body, time, load, nullptr, kDown)) {
    const double exact =
        elastic / rise * (creep_integral(g, tau, t) - creep_integral(g, tau, std::max(0.0, t - rise)));
    worst = std::max(worst, std::abs(x - exact));
  }
  std::printf("creep of a cantilever: largest error %.1e of the elastic deflection\n",
              worst / std::abs(elastic));
  EXPECT_LT(worst, kClosedForm * std::abs(elastic));
  EXPECT_LT(elastic, -1e-3);
}

// The clamped end moves at constant speed, the other one hangs on a spring: force by the relaxation of both
// in series.
TEST(Rod, pulled_at_constant_speed_relaxes) {
  const double g = 0.7, tau = 2, speed = 1e-3, k_0 = kStiffness, k_b = 5 * kStiffness;
  const double k_inf = k_0 * (1 - g), both_0 = k_0 * k_b / (k_0 + k_b),
               both_inf = k_inf * k_b / (k_inf + k_b), time_of_both = tau * (k_0 + k_b) / (k_inf + k_b);
  MarkerSetups markers;
  markers.bushings = {{"spring", {{"rod", "x_max"}, {}}, {{k_b, 0, 0}}}};
  BodySetup setup{.name = "rod", .body = rod({{g}, {tau}}, 1e-4 * tau, model::Basis::full)};
  setup.joint = {.type = body::JointType::prismatic, .axis = {1, 0, 0}};
  setup.translation.drive = speed_drive(0, speed);
  System system({setup}, {}, {}, markers);
  double worst = 0, last = 0;
  simulate(system, {.dt = 0.01, .end_time = 10, .rho_inf = 0}, [&](const model::Snapshot& s) {
    const double relaxed = (both_0 - both_inf) * time_of_both * (1 - std::exp(-s.time / time_of_both));
    last = speed * (both_inf * s.time + relaxed);
    if (s.time > 0.1) worst = std::max(worst, std::abs(s.bushings[0].force.norm() - last));
  });
  std::printf("pulled at constant speed: largest error %.1e of the last force\n", worst / last);
  EXPECT_LT(worst, kClosedForm * last);
  EXPECT_GT(last, 0.01);
}

// Storage and loss modulus over k_0.
std::complex<double> modulus(const Series& series, double omega) {
  std::complex<double> k = 1;
  for (std::size_t i = 0; i < series.g.size(); ++i)
    k -= series.g[i] / std::complex<double>(1, omega * series.tau[i]);
  return k;
}

// Complex modulus from a vibration that is forced at omega, with one term: x = Re(X e^(i omega t)) and what
// is left of the start, which falls by exp(-t/tau_c).
std::complex<double> measured_modulus(double g, double tau, double omega, int steps) {
  constexpr int kPeriods = 3;
  const double period = 2 * std::numbers::pi / omega, force = 1;
  const TimeSettings time{.dt = period / steps, .end_time = kPeriods * period, .rho_inf = 0};
  const auto found = pulled(rod({{g}, {tau}}, 1e-5 * std::min(period, tau), model::Basis::full, 1), time,
                            [&](double t) { return force * std::sin(omega * t); });
  const int n = steps;  // the last period
  Eigen::MatrixXd basis(n, 3);
  Eigen::VectorXd x(n);
  for (int i = 0; i < n; ++i) {
    const Point& p = found[found.size() - static_cast<std::size_t>(n - i)];
    basis.row(i) << std::cos(omega * p.t), -std::sin(omega * p.t), std::exp(-p.t * (1 - g) / tau);
    x[i] = p.x;
  }
  if (basis.col(2).norm() == 0) basis.conservativeResize(n, 2);
  const Eigen::VectorXd fit = basis.colPivHouseholderQr().solve(x);
  const std::complex<double> X(fit[0], fit[1]), F(0, -force);
  return F / X / kStiffness;
}

TEST(Rod, has_the_complex_modulus_over_eight_decades) {
  const double g = 0.6, tau = 1e-2;
  double worst_storage = 0, worst_loss = 0;
  for (double x = 1e-4; x < 2e4; x *= 10) {
    const auto found = measured_modulus(g, tau, x / tau, 300), exact = modulus({{g}, {tau}}, x / tau);
    worst_storage = std::max(worst_storage, std::abs(found.real() / exact.real() - 1));
    worst_loss = std::max(worst_loss, std::abs(found.imag() / exact.imag() - 1));
    EXPECT_NEAR(found.real() / exact.real(), 1, kClosedForm) << x;
    EXPECT_NEAR(found.imag() / exact.imag(), 1, kClosedForm) << x;
  }
  std::printf("complex modulus: storage within %.1e, loss within %.1e\n", worst_storage, worst_loss);
}

// Once the start has died away, a cycle takes pi k'' |X|^2, and the balance closes.
TEST(Rod, loses_the_energy_of_its_loss_modulus_in_a_cycle) {
  const Series series{{0.3, 0.3}, {1e-2, 1e-3}};
  const double omega = 200, force = 5, period = 2 * std::numbers::pi / omega;
  const TimeSettings time{.dt = period / 400, .end_time = 12 * period, .rho_inf = 1};
  std::vector<model::Energies> energy;
  pulled(
      rod(series, 1e-5, model::Basis::modal), time, [&](double t) { return force * std::sin(omega * t); },
      &energy);
  const std::complex<double> k = kStiffness * modulus(series, omega);
  const double per_cycle = std::numbers::pi * k.imag() * std::norm(force / k);
  const double found = energy.back().relaxation - energy[energy.size() - 401].relaxation;
  std::printf("loss in a cycle: off by %.1e\n", found / per_cycle - 1);
  EXPECT_NEAR(found / per_cycle, 1, kClosedForm);
  EXPECT_EQ(energy.back().dissipated, energy.back().relaxation);
  double worst = 0;
  for (const model::Energies& e : energy) worst = std::max(worst, std::abs(e.balance));
  std::printf("balance of energy: %.1e of what is lost\n", worst / energy.back().dissipated);
  EXPECT_LT(worst, 1e-4 * energy.back().dissipated);
}

// The rod in its first mode, q'' + omega^2 (q - g z) = 0 from q = z = 0 and the velocity v.
struct Decay {
  double omega, g, tau, v;

  double operator()(double t) const {
    Eigen::Matrix3d companion =
        Eigen::Matrix3d::Zero();  // of tau s^3 + s^2 + omega^2 tau s + omega^2 (1 - g)
    companion(1, 0) = companion(2, 1) = 1;
    companion.col(2) << -omega * omega * (1 - g) / tau, -omega * omega, -1 / tau;
    std::complex<double> q = 0;
    for (const std::complex<double> s : Eigen::EigenSolver<Eigen::Matrix3d>(companion).eigenvalues())
      q += v * (1.0 + s * tau) / (3 * tau * s * s + 2.0 * s + omega * omega * tau) * std::exp(s * t);
    return q.real();
  }
};

// Largest error of the free decay over ten periods, in v / omega.
double decay_error(double tau_omega, int steps, double rho_inf) {
  const double g = 0.4, v = 0.1;
  const auto measure = rod({}, 1e-3, model::Basis::modal, 20, 1);
  const double omega = 2 * std::numbers::pi * measure->frequency[0], period = 1 / measure->frequency[0];
  const auto body = rod({{g}, {tau_omega / omega}}, 1e-3, model::Basis::modal, 20, 1);
  System system({{.name = "rod", .body = body, .q_dot0 = Eigen::VectorXd::Constant(1, v)}}, {});
  const Decay exact{omega, g, tau_omega / omega, v};
  double worst = 0;
  simulate(system, {.dt = period / steps, .end_time = 10 * period, .rho_inf = rho_inf},
           [&](const model::Snapshot& s) {
             worst = std::max(worst, std::abs(s.bodies[0].q[0] - exact(s.time)) * omega / v);
           });
  return worst;
}

TEST(Rod, first_mode_decays_freely_as_its_characteristic_equation_says) {
  for (double tau_omega : {0.01, 1.0, 100.0}) {
    const double error = decay_error(tau_omega, 1000, 1);
    std::printf("free decay, omega tau = %g: largest error %.1e of the elastic amplitude\n", tau_omega,
                error);
    EXPECT_LT(error, kClosedForm) << tau_omega;
  }
}

TEST(Rod, integration_is_of_second_order) {
  for (double rho_inf : {1.0, 0.8, 0.0})
    for (double tau_omega : {1e-4, 0.05, 1.0, 20.0}) {
      const double coarse = decay_error(tau_omega, 200, rho_inf), fine = decay_error(tau_omega, 400, rho_inf);
      std::printf("rho_inf %g, omega tau = %g: order %.3f\n", rho_inf, tau_omega, std::log2(coarse / fine));
      EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15) << rho_inf << " " << tau_omega;
    }
}

// Steps of any length stay bounded: far above and far below the relaxation times and the periods.
TEST(Rod, integration_is_stable_for_every_relaxation_time) {
  for (double rho_inf : {1.0, 0.5})
    for (double tau : {1e-7, 1e-4, 1e-2, 1.0, 1e5}) {
      const auto body = rod({{0.5, 0.3}, {tau, 3 * tau}}, 1e-3, model::Basis::modal, 8);
      System system({{.name = "rod", .body = body, .q_dot0 = Eigen::VectorXd::Constant(body->n_q(), 0.1)}},
                    {});
      double first = 0, largest = 0;
      simulate(system, {.dt = 0.01, .end_time = 5, .rho_inf = rho_inf}, [&](const model::Snapshot& s) {
        const double energy = s.energy.kinetic + s.energy.elastic;
        if (s.time == 0) first = energy;
        largest = std::max(largest, energy);
      });
      EXPECT_LT(largest, 3 * first) << rho_inf << " " << tau;
    }
}

// Rod with a body of several parts: all energy is accounted for.
TEST(Rod, energy_closes_where_parts_relax_apart) {
  test::BoxSpec spec{.size = {1, 0.5, 0.5}, .cells = {2, 1, 1}, .material = {kE, 0.3, 1000}};
  spec.held = [](const Vector3d& X, int) { return X.x() == 0; };
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::full));
  spec.material.nu = -0.2;  // another stiffness of the same body
  const Eigen::SparseMatrix<double> other = test::make_box(spec, model::Basis::full).K_r;
  body->relaxing = {
      {"a", model::ModulusPart::shear, vector_of({0.3, 0.2}), vector_of({1e-3, 0.1}), 0.5 * body->K_r},
      {"b", model::ModulusPart::both, vector_of({0.5}), vector_of({1e-2}), 0.4 * other}};
  System system({{.name = "box", .body = body, .q_dot0 = test::uniform_velocity(*body, {0.1, 0.2, -0.1})}},
                {});
  double largest = 0, lost = 0, worst = 0;
  simulate(system, {.dt = 1e-3, .end_time = 0.3, .output_dt = 0.7e-3}, [&](const model::Snapshot& s) {
    largest = std::max(largest, s.energy.kinetic + s.energy.elastic);
    worst = std::max(worst, std::abs(s.energy.balance));
    lost = s.energy.relaxation;
  });
  EXPECT_GT(lost, 0.3 * largest);
  EXPECT_LT(worst, 0.02 * largest);  // between steps
  System again({{.name = "box", .body = body, .q_dot0 = test::uniform_velocity(*body, {0.1, 0.2, -0.1})}},
               {});
  const RunSummary run = simulate(again, {.dt = 1e-3, .end_time = 0.3}, {});
  EXPECT_LT(run.largest_imbalance, 1e-9 * largest);
}

std::vector<Eigen::VectorXd> free_flight(const Series& series, const Environment& environment = {}) {
  const auto body = rod(series, 1e-3, model::Basis::full, 4);
  System system({{.name = "rod", .body = body, .q_dot0 = test::uniform_velocity(*body, {1, 0, 0})}}, {},
                environment);
  std::vector<Eigen::VectorXd> q;
  simulate(system, {.dt = 1e-4, .end_time = 0.02},
           [&](const model::Snapshot& s) { q.push_back(s.bodies[0].q); });
  return q;
}

double largest_difference(const std::vector<Eigen::VectorXd>& a, const std::vector<Eigen::VectorXd>& b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, (a[i] - b[i]).norm());
    size = std::max(size, b[i].norm());
  }
  return difference / size;
}

TEST(Rod, term_that_cannot_be_felt_leaves_the_elastic_motion) {
  const auto elastic = free_flight({});
  std::printf("no term: %.1e, a time beyond the run: %.1e of the elastic motion\n",
              largest_difference(free_flight({{0}, {1e-3}}), elastic),
              largest_difference(free_flight({{0.9}, {1e10}}), elastic));
  EXPECT_LT(largest_difference(free_flight({{0}, {1e-3}}), elastic), 1e-9);
  EXPECT_LT(largest_difference(free_flight({{0.9}, {1e10}}), elastic), 1e-9);
  EXPECT_LT(
      largest_difference(free_flight({{0.9}, {1e-3}}, {.moduli = body::Moduli::instantaneous}), elastic),
      1e-9);
  EXPECT_GT(largest_difference(free_flight({{0.9}, {1e-3}}), elastic), 0.1);
}

TEST(Rod, at_rest_has_its_instantaneous_or_long_term_length) {
  const Series series{{0.3, 0.4}, {1, 100}};
  for (model::Basis basis : {model::Basis::modal, model::Basis::full}) {
    const auto body = rod(series, 1e-3, basis);
    const auto stretched = [&](body::Moduli moduli) {
      MarkerSetups markers;
      markers.loads = {{"pull", {"rod", "x_max"}, {4, 0, 0}}};
      scale_by_load_factor(markers, 1);
      System system({{.name = "rod", .body = body}}, {}, {.moduli = moduli}, markers);
      double x = 0, energy = 0;
      solve_static(system, {2}, [&](const model::Snapshot& s) {
        x = tip(*body, s);
        energy = s.energy.elastic;
        EXPECT_NEAR(s.energy.balance, 0, 1e-9);
      });
      EXPECT_NEAR(energy, 0.5 * 4 * x, 1e-9);
      return x * kStiffness / 4;
    };
    EXPECT_NEAR(stretched(body::Moduli::instantaneous), 1, 1e-7);
    EXPECT_NEAR(stretched(body::Moduli::long_term), 1 / 0.3, 1e-7);
    EXPECT_NE(test::message_of([&] { stretched(body::Moduli::relaxing); }).find("moduli"), std::string::npos);
  }
}

// Steps that are chosen by their error, and others that are rejected, keep the history.
TEST(Rod, creeps_the_same_with_steps_chosen_by_their_error) {
  const double g = 0.6, tau = 1, force = 3, rise = 0.2;
  const auto load = [&](double t) {
    return force * std::pow(std::sin(std::min(1.0, t / rise) * M_PI / 2), 2);
  };
  const auto body = rod({{g}, {tau}}, 1e-3, model::Basis::full);
  const auto fine = pulled(body, {.dt = 5e-4, .end_time = 2, .rho_inf = 0.5, .output_dt = 0.1}, load);
  const auto chosen = pulled(
      body, {.dt = 2e-2, .end_time = 2, .rho_inf = 0.5, .output_dt = 0.1, .step_tolerance = 1e-9}, load);
  ASSERT_EQ(fine.size(), chosen.size());
  for (std::size_t i = 0; i < fine.size(); ++i)
    EXPECT_NEAR(chosen[i].x, fine[i].x, kClosedForm * force / kStiffness) << fine[i].t;
}

}  // namespace
}  // namespace elastogear::relaxation_test
