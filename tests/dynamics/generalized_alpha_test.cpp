// Accuracy, stability and conservation of the time integrator.
#include <cmath>
#include <map>

#include "../message_of.h"
#include "second_order_problem.h"

namespace elastogear::generalized_alpha_test {
using namespace test;
namespace {

constexpr double order_tolerance = 0.1;  // of a measured order of convergence
constexpr double newton_tolerance = 1e-10;

// M A + D V + K U = f(t) with an exact solution that has U, V and A all different from zero at t = 0.
struct LinearProblem {
  Matrix2d M{{2, 0.3}, {0.3, 1}}, D{{0.3, -0.1}, {-0.1, 0.2}}, K{{6, -2}, {-2, 4}};

  static Vector2d U(double t) { return {std::cos(t) + std::sin(2 * t), std::exp(-t)}; }
  static Vector2d V(double t) { return {-std::sin(t) + 2 * std::cos(2 * t), -std::exp(-t)}; }
  static Vector2d A(double t) { return {-std::cos(t) - 4 * std::sin(2 * t), std::exp(-t)}; }

  Problem problem() const {
    const LinearProblem p = *this;
    return {[p](double t, const VectorXd& u, const VectorXd& v, const VectorXd& a) -> VectorXd {
              return p.M * (a - A(t)) + p.D * (v - V(t)) + p.K * (u - U(t));
            },
            [p](double, const VectorXd&, double shift_V, double shift_A) -> MatrixXd {
              return p.K + shift_V * p.D + shift_A * p.M;
            },
            U(0), V(0)};
  }
};

Problem oscillator(double omega) {
  const double k = omega * omega;
  return {
      [k](double, const VectorXd& U, const VectorXd&, const VectorXd& A) -> VectorXd { return A + k * U; },
      [k](double, const VectorXd&, double, double shift_A) { return MatrixXd::Constant(1, 1, k + shift_A); },
      VectorXd::Constant(1, 1.0), VectorXd::Constant(1, 0.5)};
}

constexpr double pendulum_angle = 2;  // rad, far from linear

Problem pendulum() {
  return {[](double, const VectorXd& U, const VectorXd&, const VectorXd& A) -> VectorXd {
            return A + U.array().sin().matrix();
          },
          [](double, const VectorXd& U, double, double shift_A) {
            return MatrixXd::Constant(1, 1, std::cos(U[0]) + shift_A);
          },
          VectorXd::Constant(1, pendulum_angle), VectorXd::Zero(1)};
}

// Classical Runge-Kutta with steps so small that its error is roundoff.
struct PendulumReference {
  double t = 0;
  Vector2d y{pendulum_angle, 0};

  static Vector2d rate(const Vector2d& y) { return {y[1], -std::sin(y[0])}; }
  void advance(double to) {
    const int n = static_cast<int>(std::ceil(std::abs(to - t) / 1e-3));
    const double h = (to - t) / n;
    for (int i = 0; i < n; i++) {
      const Vector2d a = rate(y), b = rate(y + h / 2 * a), c = rate(y + h / 2 * b), d = rate(y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
    t = to;
  }
};

std::string text(double x) {
  std::ostringstream out;
  out.precision(17);
  out << x;
  return out.str();
}

std::string fixed_steps(double dt, double t_end, double rho_inf) {
  return "-ts_dt " + text(dt) + " -ts_max_time " + text(t_end) + " -ts_alpha_radius " + text(rho_inf) +
         " -snes_rtol 1e-13 ";
}

struct Errors {
  double U = 0, V = 0;
  void add(double u, double v) {
    U = std::max(U, u);
    V = std::max(V, v);
  }
};

Errors linear_errors(double dt, double rho_inf) {
  Errors e;
  Integration run(LinearProblem().problem(), fixed_steps(dt, 4, rho_inf),
                  [&](double t, const VectorXd& U, const VectorXd& V) {
                    e.add((U - LinearProblem::U(t)).norm(), (V - LinearProblem::V(t)).norm());
                  });
  run.solve();
  return e;
}

Errors pendulum_errors(double dt, double rho_inf) {
  Errors e;
  PendulumReference reference;
  Integration run(pendulum(), fixed_steps(dt, 8, rho_inf),
                  [&](double t, const VectorXd& U, const VectorXd& V) {
                    if (t > 0) reference.advance(t);
                    e.add(std::abs(U[0] - reference.y[0]), std::abs(V[0] - reference.y[1]));
                  });
  run.solve();
  return e;
}

void expect_second_order(const Errors& coarse, const Errors& fine) {
  const double order_U = std::log2(coarse.U / fine.U), order_V = std::log2(coarse.V / fine.V);
  ::testing::Test::RecordProperty("order_U", text(order_U));
  ::testing::Test::RecordProperty("order_V", text(order_V));
  EXPECT_NEAR(order_U, 2, order_tolerance);
  EXPECT_NEAR(order_V, 2, order_tolerance);
}

class GeneralizedAlpha : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(radius, GeneralizedAlpha, ::testing::Values(1.0, 0.8, 0.5, 0.0));

TEST_P(GeneralizedAlpha, is_second_order_on_a_damped_forced_oscillator) {
  expect_second_order(linear_errors(0.02, GetParam()), linear_errors(0.01, GetParam()));
}

TEST_P(GeneralizedAlpha, is_second_order_on_a_pendulum) {
  expect_second_order(pendulum_errors(0.02, GetParam()), pendulum_errors(0.01, GetParam()));
}

// Every second step half as long as the others, given in advance.
double error_with_alternating_steps(int n, double rho_inf) {
  const double t_end = 8;
  std::vector<PetscReal> times{0};
  for (int i = 0; i < n; i++) times.push_back(times.back() + t_end / n * (i % 2 ? 2. : 4.) / 3);
  times.back() = t_end;
  Integration run(pendulum(), fixed_steps(times[1], t_end, rho_inf));
  TSAdapt adapt = nullptr;
  check(TSGetAdapt(run.ts, &adapt));
  check(TSAdaptSetType(adapt, TSADAPTHISTORY));
  check(TSAdaptHistorySetHistory(adapt, n + 1, times.data(), PETSC_FALSE));
  run.solve();
  PetscInt steps = 0;
  check(TSGetStepNumber(run.ts, &steps));
  EXPECT_EQ(steps, n);
  PendulumReference reference;
  reference.advance(t_end);
  return std::hypot(run.displacement()[0] - reference.y[0], run.velocity()[0] - reference.y[1]);
}

TEST_P(GeneralizedAlpha, is_second_order_with_changing_steps) {
  const double coarse = error_with_alternating_steps(400, GetParam());
  const double fine = error_with_alternating_steps(800, GetParam());
  EXPECT_NEAR(std::log2(coarse / fine), 2, order_tolerance);
}

// The step maps (U, dt V, dt^2 A) to itself: its matrix, column by column from single steps.
Eigen::Matrix3d amplification(double omega, double dt, double rho_inf) {
  Eigen::Matrix3d result;
  for (int j = 0; j < 3; j++) {
    const Eigen::Vector3d x = Eigen::Vector3d::Unit(j);
    Integration run(oscillator(omega), fixed_steps(dt, 1e9, rho_inf) + "-ts_max_steps 1");
    const auto column = [](double value) { return vector(VectorXd::Constant(1, value)); };
    dynamics::generalized_alpha_set_state(run.ts, column(x[0]), column(x[1] / dt), column(x[2] / (dt * dt)));
    run.solve();
    result.col(j) << run.displacement()[0], dt * run.velocity()[0], dt * dt * run.acceleration()[0];
  }
  return result;
}

TEST_P(GeneralizedAlpha, damps_infinite_frequencies_by_the_spectral_radius) {
  const double radius = amplification(1, 1e4, GetParam()).eigenvalues().cwiseAbs().maxCoeff();
  const double triple_root_tolerance = 1e-2;  // cube root of 1 / (omega dt)^2
  EXPECT_NEAR(radius, GetParam(), triple_root_tolerance);
}

TEST_P(GeneralizedAlpha, keeps_low_frequencies) {
  const double radius = amplification(1, 1e-2, GetParam()).eigenvalues().cwiseAbs().maxCoeff();
  EXPECT_NEAR(radius, 1, 1e-5);
  EXPECT_LE(radius, 1 + 1e-12);
}

double final_energy(double dt, double rho_inf) {
  const double omega = 3;
  Integration run(oscillator(omega), fixed_steps(dt, 200 * dt, rho_inf));
  run.solve();
  return 0.5 * run.velocity().squaredNorm() + 0.5 * omega * omega * run.displacement().squaredNorm();
}

TEST_P(GeneralizedAlpha, keeps_energy_without_and_loses_it_with_dissipation) {
  const double initial = 0.5 * 0.25 + 0.5 * 9;
  if (GetParam() == 1)
    EXPECT_NEAR(final_energy(0.1, 1), initial, newton_tolerance * initial);
  else
    EXPECT_LT(final_energy(0.1, GetParam()), initial * (1 - 1e-4));
}

TEST(GeneralizedAlphaStart, has_the_exact_acceleration) {
  Integration linear(LinearProblem().problem(), "-ts_max_time 1");
  EXPECT_LT((linear.acceleration() - LinearProblem::A(0)).norm(), 1e-12);
  Integration swinging(pendulum(), "-ts_max_time 1");
  EXPECT_NEAR(swinging.acceleration()[0], -std::sin(pendulum_angle), 1e-12);
  Integration stiff(oscillator(1e5), "-ts_max_time 1 -ts_dt 0.1");
  EXPECT_NEAR(stiff.acceleration()[0], -1e10, 1e-12 * 1e10);
}

TEST(GeneralizedAlphaStart, solves_a_mass_that_depends_on_the_acceleration) {
  const Problem stiffening{[](double, const VectorXd& U, const VectorXd&, const VectorXd& A) -> VectorXd {
                             return (A.array() + A.array().cube() + U.array()).matrix();
                           },
                           [](double, const VectorXd&, double, double shift_A) {
                             return MatrixXd::Constant(1, 1, 1 + shift_A * (1 + 3));  // at A = -1
                           },
                           VectorXd::Constant(1, 2.0), VectorXd::Zero(1)};
  Integration run(stiffening, "-ts_max_time 1 -snes_rtol 1e-14");
  EXPECT_NEAR(run.acceleration()[0], -1, newton_tolerance);
}

double interpolation_error(double dt) {
  double error = 0;
  PendulumReference reference;
  Integration* self = nullptr;
  const UniqueVec between = vector(VectorXd::Zero(1));
  Integration run(pendulum(), fixed_steps(dt, 2, 1), [&](double t, const VectorXd& U, const VectorXd& V) {
    if (t == 0) return;
    for (const double s : {0.3, 0.5, 0.8}) {
      check(TSInterpolate(self->ts, t + (s - 1) * dt, between));
      // against the cubic's own ends, moved onto the exact solution: the error of interpolation alone
      PendulumReference at_end{t, {U[0], V[0]}};
      at_end.advance(t + (s - 1) * dt);
      error = std::max(error, std::abs(values(between)[0] - at_end.y[0]));
    }
  });
  self = &run;
  run.solve();
  return error;
}

TEST(GeneralizedAlphaInterpolation, has_at_least_third_order) {
  const double order = std::log2(interpolation_error(0.1) / interpolation_error(0.05));
  EXPECT_GT(order, 3 - order_tolerance);
}

TEST(GeneralizedAlphaInterpolation, ends_at_the_final_time_between_steps) {
  Integration run(pendulum(), "-ts_dt 0.03 -ts_max_time 1 -ts_exact_final_time interpolate");
  PendulumReference reference;
  reference.advance(1);
  const UniqueVec U = vector(run.problem.U0);
  check(TSSolve(run.ts, U));
  EXPECT_NEAR(values(U)[0], reference.y[0], 1e-3);
  PetscReal t = 0;
  check(TSGetTime(run.ts, &t));
  EXPECT_GT(t, 1);
}

// A fast damped mode (0.01 s) dies away, a slow exact solution remains.
Problem stiff_then_smooth() {
  const double k = 1e4, d = 250;
  return {[=](double t, const VectorXd& U, const VectorXd& V, const VectorXd& A) -> VectorXd {
            return VectorXd::Constant(
                1, A[0] + std::sin(t) + d * (V[0] - std::cos(t)) + k * (U[0] - std::sin(t)));
          },
          [=](double, const VectorXd&, double shift_V, double shift_A) {
            return MatrixXd::Constant(1, 1, k + shift_V * d + shift_A);
          },
          VectorXd::Constant(1, 1.0), VectorXd::Constant(1, 1.0)};
}

// U = sin t + c1 exp(-50 t) + c2 exp(-200 t) from the roots of s^2 + 250 s + 1e4.
double stiff_then_smooth_exact(double t) {
  return std::sin(t) + 4. / 3 * std::exp(-50 * t) - 1. / 3 * std::exp(-200 * t);
}

struct AdaptiveRun {
  double error = 0, smallest = 1e9, largest = 0, t = 0;
  int steps = 0;
};

AdaptiveRun adaptive_run(const std::string& tolerances) {
  AdaptiveRun result;
  Integration run(
      stiff_then_smooth(),
      "-ts_dt 1e-5 -ts_max_time 5 -ts_max_steps 100000 -ts_adapt_type basic -ts_alpha_radius 0 " + tolerances,
      [&](double t, const VectorXd& U, const VectorXd&) {
        result.error = std::max(result.error, std::abs(U[0] - stiff_then_smooth_exact(t)));
        if (t > 0 && t < 5) result.largest = std::max(result.largest, t - result.t);
        if (t > 0) result.smallest = std::min(result.smallest, t - result.t);
        if (t > 0) result.steps++;
        result.t = t;
      });
  run.solve();
  return result;
}

// The error of a step is held at the tolerance, so steps go with its cube root and the global error with the
// power 2/3.
TEST(GeneralizedAlphaAdaptivity, follows_the_tolerance_and_the_scale_of_the_solution) {
  const AdaptiveRun loose = adaptive_run("-ts_rtol 0 -ts_atol 1e-4");
  const AdaptiveRun tight = adaptive_run("-ts_rtol 0 -ts_atol 1e-6");
  EXPECT_LT(loose.error, 20 * 1e-4);
  EXPECT_NEAR(std::log(loose.error / tight.error) / std::log(100.), 2. / 3, 0.1);
  EXPECT_NEAR(std::log(static_cast<double>(tight.steps) / loose.steps) / std::log(100.), 1. / 3, 0.05);
  EXPECT_GT(loose.largest, 50 * loose.smallest);
  EXPECT_LT(loose.steps, 500);
}

TEST(GeneralizedAlphaAdaptivity, controls_the_velocity_by_its_own_tolerance) {
  const AdaptiveRun free = adaptive_run("-ts_rtol 0 -ts_atol 1e-4");
  const AdaptiveRun loose = adaptive_run("-ts_rtol 0 -ts_atol 1e-4 -ts_alpha_velocity_atol 1e6");
  const AdaptiveRun tight = adaptive_run("-ts_rtol 0 -ts_atol 1e-4 -ts_alpha_velocity_atol 1e-3");
  EXPECT_EQ(free.steps, loose.steps);
  EXPECT_GT(tight.steps, 2 * free.steps);
  EXPECT_LT(tight.error, free.error);
}

TEST(GeneralizedAlphaOptions, alpha2_stays_petscs_own) {
  Integration petscs(pendulum(), "-ts_type alpha2 " + fixed_steps(0.05, 2, 0.5));
  petscs.solve();
  EXPECT_EQ(message_of([&] { dynamics::generalized_alpha_restart(petscs.ts); }),
            "TS type alpha2: must be generalized_alpha");
}

TEST(GeneralizedAlphaOptions, parameters_weight_the_new_state) {
  Integration by_radius(pendulum(), fixed_steps(0.05, 2, 0.5));
  Integration one_by_one(pendulum(),
                         "-ts_dt 0.05 -ts_max_time 2 -snes_rtol 1e-13 -ts_alpha_alpha_m 1 "
                         "-ts_alpha_alpha_f 0.6666666666666667 -ts_alpha_gamma 0.8333333333333333 "
                         "-ts_alpha_beta 0.4444444444444444");
  by_radius.solve();
  one_by_one.solve();
  EXPECT_NEAR(by_radius.displacement()[0], one_by_one.displacement()[0], newton_tolerance);
  PetscReal alpha_m = 0;
  check(TSAlpha2GetParams(one_by_one.ts, &alpha_m, nullptr, nullptr, nullptr));
  EXPECT_EQ(alpha_m, 1);
}

TEST(GeneralizedAlphaOptions, every_predictor_reaches_the_same_solution) {
  std::map<std::string, double> angle;
  for (const std::string name : {"none", "constant_acceleration", "zero_acceleration"}) {
    Integration run(pendulum(), fixed_steps(0.05, 2, 0.8) + "-ts_alpha_predictor " + name);
    run.solve();
    angle[name] = run.displacement()[0];
  }
  EXPECT_NEAR(angle["none"], angle["constant_acceleration"], newton_tolerance);
  EXPECT_NEAR(angle["zero_acceleration"], angle["constant_acceleration"], newton_tolerance);
}

TEST(GeneralizedAlphaOptions, wrong_values_are_refused) {
  for (const std::string wrong :
       {"-ts_alpha_radius 1.5", "-ts_alpha_radius -0.1", "-ts_alpha_beta 0", "-ts_alpha_alpha_f -1",
        "-ts_alpha_velocity_atol -1", "-ts_alpha_predictor best"})
    EXPECT_ANY_THROW(Integration(pendulum(), wrong)) << wrong;
}

}  // namespace
}  // namespace elastogear::generalized_alpha_test
