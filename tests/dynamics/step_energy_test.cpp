// Steps that a run chooses neither make energy nor lose the stresses: docs/theory, section 8.3.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "box_body.h"
#include "elastogear/body/rigid.h"
#include "elastogear/dynamics/simulate.h"
#include "markers.h"
#include "second_order_problem.h"

namespace elastogear::step_energy_test {
using namespace test;
namespace {

using namespace dynamics;

constexpr double kPeriod = 2 * M_PI;

// U'' + U = 0 from U = 1 at rest.
test::Problem oscillator() {
  return {[](double, const VectorXd& U, const VectorXd&, const VectorXd& A) -> VectorXd { return A + U; },
          [](double, const VectorXd&, double, double shift_A) -> MatrixXd {
            return MatrixXd::Constant(1, 1, 1 + shift_A);
          },
          VectorXd::Ones(1), VectorXd::Zero(1)};
}

struct Swing {
  double most = 0, end = 0;  // amplitudes
  int steps = 0;
};

// Steps by PETSc's control, cut at multiples of `output` where that is positive.
Swing swing(double rho_inf, double tolerance, double periods, double output) {
  Swing swing;
  Integration* run = nullptr;
  std::ostringstream options;
  options << "-ts_dt 1e-3 -ts_adapt_type basic -ts_max_time " << periods * kPeriod << " -ts_alpha_radius "
          << rho_inf;
  Integration integration(oscillator(), options.str(), [&](double t, const VectorXd& U, const VectorXd& V) {
    swing.end = std::hypot(U[0], V[0]);
    swing.most = std::max(swing.most, swing.end);
    swing.steps++;
    PetscReal dt = 0;
    if (!run || output == 0) return;
    check(TSGetTimeStep(run->ts, &dt));
    const double left = output * (std::floor(t / output + 1e-9) + 1) - t;
    check(TSSetTimeStep(run->ts, left / std::ceil(left / dt)));
  });
  run = &integration;
  generalized_alpha_set_tolerances(integration.ts, test::vector(VectorXd::Ones(1)), tolerance, 0);
  integration.solve();
  return swing;
}

// Amplitudes of 1 to 1e5 tolerances, with and without times of output.
TEST(ChosenSteps, of_an_oscillator_never_make_energy) {
  constexpr double kRoundoff = 1e-9;
  for (const double rho_inf : {0.0, 0.5, 0.8, 0.95, 1.0})
    for (const double amplitude : {1.0, 10.0, 1e3, 1e5})
      for (const double output : {0.0, 0.7}) {
        const double periods = amplitude > 1e3 ? 50 : 1000;
        const Swing result = swing(rho_inf, 1 / amplitude, periods, output);
        EXPECT_LE(result.most, 1 + kRoundoff) << rho_inf << ", " << amplitude << ", " << output;
        EXPECT_LE(1 - result.end, result.steps / amplitude) << rho_inf << ", " << amplitude;
      }
}

// A mass of 1 kg on a spring of 1e8 N/m, started with 0.1 m/s: some 300 periods. Within a period the energy
// of states swings by less than a local error; from period to period numerical damping takes some.
TEST(ChosenSteps, of_a_mass_on_a_stiff_spring_keep_its_energy) {
  const auto mass = std::make_shared<model::ElasticBody>(
      body::rigid_body(1, Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(1e-3).asDiagonal()));
  struct Case {
    double step_error, output, swing, least;
  };
  for (const Case& c : {Case{1e-4, 0, 1e-6, 0.9}, Case{1e-4, 1e-3, 1e-6, 0.9}, Case{1e-5, 0, 5e-6, 0.99},
                        Case{1e-5, 1e-3, 5e-6, 0.99}}) {
    MarkerSetups setups;
    setups.bushings = {{"spring", {{}, {"mass", "frame"}}}};
    setups.bushings[0].law = {Eigen::Vector3d::Constant(1e8), Eigen::Vector3d::Zero()};
    BodySetup setup{.name = "mass", .body = mass, .joint = {body::JointType::prismatic}};
    setup.translation.s_dot_0 = 0.1;
    System system({setup}, {}, {}, setups);
    TimeSettings settings{.end_time = 0.2, .rho_inf = 0.8};
    settings.step_error = c.step_error;
    settings.output_dt = c.output;
    const double start = 0.5 * 0.1 * 0.1;
    double most = 0, late = 0, least = start;
    const RunSummary run = simulate(system, settings, [&](const model::Snapshot& s) {
      const double energy = s.energy.kinetic + s.energy.bushing;
      most = std::max(most, energy);
      if (s.time > 0.1 * settings.end_time) late = std::max(late, energy);
      least = std::min(least, energy);
    });
    EXPECT_LE(most, start * (1 + c.swing)) << c.step_error;
    EXPECT_LT(late, start) << c.step_error;
    EXPECT_GE(least, c.least * start) << c.step_error;
    EXPECT_LT(run.largest_imbalance, (1 - c.least) * start) << c.step_error;
  }
}

// A steel bar of 500 x 20 x 20 mm, held at one end, with 20 modes.
std::shared_ptr<model::ElasticBody> bar() {
  const test::BoxSpec spec{.size = {0.5, 0.02, 0.02},
                           .cells = {25, 1, 1},
                           .material = {210e9, 0.3, 7850},
                           .held = [](const Eigen::Vector3d& X, int) { return X[0] == 0; }};
  auto body = std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::modal, 20));
  body->markers = {test::end_marker(*body, 1)};
  return body;
}

// A half-sine of 1000 N and 0.2 ms, as a table of 40 steps.
Signal pulse() {
  std::vector<double> time, value;
  for (int i = 0; i <= 40; ++i) {
    time.push_back(2e-4 * i / 40);
    value.push_back(1000 * std::sin(M_PI * i / 40));
  }
  time.push_back(1);
  value.push_back(0);
  return table_signal(time, value);
}

// The motion of q'' + omega^2 q = phi f(t) under a load that is linear between the times of its table.
struct ExactMode {
  double omega = 0, phi = 0, q = 0, v = 0, t = 0;

  void go_to(double end, const Signal& load) {
    for (std::size_t i = 0; i <= load.time.size() && t < end; ++i) {
      const double next = i < load.time.size() ? std::min(load.time[i], end) : end;
      if (next > t) advance(next - t, at(load, t), (at(load, next) - at(load, t)) / (next - t));
    }
  }
  void advance(double dt, double force, double slope) {
    const double s = phi / (omega * omega), a = q - s * force, b = (v - s * slope) / omega, w = omega * dt;
    q = a * std::cos(w) + b * std::sin(w) + s * (force + slope * dt);
    v = omega * (b * std::cos(w) - a * std::sin(w)) + s * slope;
    t += dt;
  }
};

struct Outcome {
  double error = 0, found = 0, exact = 0;  // largest energy norms: of the error, as found, as they are
  int steps = 0;
};

// Beside the exact motion of the modes.
Outcome under_pulse(double step_error) {
  const auto body = bar();
  MarkerSetups setups;
  setups.loads = {{"pulse", {"bar", body->markers[0].name}, {0, 0, 1}}};
  setups.loads[0].signal = pulse();
  System system({{.name = "bar", .body = body}}, {}, {}, setups);
  const Eigen::VectorXd K = body->K_r.diagonal(), phi = model::dense_rows(body->markers[0].Phi)->row(2);
  std::vector<ExactMode> modes;
  for (Eigen::Index k = 0; k < K.size(); ++k) modes.push_back({std::sqrt(K[k]), phi[k]});
  TimeSettings settings{.end_time = 0.01, .rho_inf = 0.8};
  settings.step_error = step_error;
  settings.output_dt = 2e-5;
  Outcome outcome;
  const RunSummary run = simulate(system, settings, [&](const model::Snapshot& s) {
    Eigen::VectorXd q(K.size());
    for (std::size_t k = 0; k < modes.size(); ++k) {
      modes[k].go_to(s.time, setups.loads[0].signal);
      q[static_cast<Eigen::Index>(k)] = modes[k].q;
    }
    const auto norm = [&](const Eigen::VectorXd& x) { return std::sqrt(x.dot(K.cwiseProduct(x))); };
    outcome.error = std::max(outcome.error, norm(s.bodies[0].q - q));
    outcome.found = std::max(outcome.found, norm(s.bodies[0].q));
    outcome.exact = std::max(outcome.exact, norm(q));
  });
  outcome.steps = run.steps;
  return outcome;
}

// The pulse excites modes of 10 kHz, whose phases errors of the second order shift for 10 ms.
TEST(ChosenSteps, resolve_the_stress_of_a_bar_under_a_pulse) {
  constexpr double kHistory[2] = {0.15, 0.05};  // found: 0.135, 0.047
  const Outcome coarser = under_pulse(1e-4), chosen = under_pulse(TimeSettings().step_error);
  EXPECT_NEAR(chosen.found, chosen.exact, 0.01 * chosen.exact);
  EXPECT_LT(coarser.error, kHistory[0] * coarser.exact) << coarser.steps << " steps";
  EXPECT_LT(chosen.error, kHistory[1] * chosen.exact) << chosen.steps << " steps";
}

}  // namespace
}  // namespace elastogear::step_energy_test
