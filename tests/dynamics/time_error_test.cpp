// What the steps of a run leave in oscillators is known as they are taken: docs/theory, section 8.8.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <optional>
#include <sstream>

#include "dynamics/errors/time_error.h"
#include "elastogear/dynamics/generalized_alpha.h"
#include "second_order_problem.h"

namespace elastogear::time_error_test {
using namespace test;
namespace {

using namespace dynamics;

constexpr double kRoundoff = 1e-12;

Oscillators oscillator(double damping, double stiffness = 1) {
  return {Eigen::ArrayXd::Ones(1), Eigen::ArrayXd::Constant(1, damping),
          Eigen::ArrayXd::Constant(1, stiffness)};
}

// Twice a time is that time after itself, for power series and closed forms alike.
TEST(Responses, continue_each_other_at_any_damping) {
  for (const double damping : {0.0, 0.02, 1.0, 2.0, 5.0})
    for (double t = 1e-6; t < 20; t *= 2) {
      const Responses once = responses(oscillator(damping), t), twice = responses(oscillator(damping), 2 * t);
      const double g = once.g[0], held = once.g_dot[0] + damping * g;
      const double P_0 = once.P_0[0], P_1 = once.P_1[0], P_2 = once.P_2[0];
      EXPECT_NEAR(twice.g[0], held * g + g * once.g_dot[0], kRoundoff * t) << damping << ", " << t;
      EXPECT_NEAR(twice.P_0[0], held * P_0 + g * g + P_0, kRoundoff * t * t) << damping << ", " << t;
      EXPECT_NEAR(twice.P_1[0], held * P_1 + g * P_0 + t * P_0 + P_1, kRoundoff * t * t * (1 + t));
      EXPECT_NEAR(twice.P_2[0], held * P_2 + g * P_1 + t * t / 2 * P_0 + t * P_1 + P_2,
                  kRoundoff * t * t * (1 + t * t));
    }
}

// U" + d U' + U = cos(w t) from U_0 at rest.
struct Forced {
  double d, w, U_0;
  std::complex<double> s_1 = {}, s_2 = {}, a_1 = {}, a_2 = {}, a_p = {};

  Forced(double damping, double frequency, double start) : d(damping), w(frequency), U_0(start) {
    const std::complex<double> i(0, 1), root = std::sqrt(std::complex<double>(d * d / 4 - 1));
    s_1 = -d / 2 + root, s_2 = -d / 2 - root;
    a_p = 1.0 / (1 - w * w + i * w * d);
    const double U = U_0 - a_p.real(), V = -(i * w * a_p).real();
    a_1 = (V - s_2 * U) / (s_1 - s_2), a_2 = U - a_1;
  }
  double at(double t) const {
    return (a_1 * std::exp(s_1 * t) + a_2 * std::exp(s_2 * t) +
            a_p * std::exp(std::complex<double>(0, w * t)))
        .real();
  }
  test::Problem problem() const {
    return {[*this](double t, const VectorXd& U, const VectorXd& V, const VectorXd& A) -> VectorXd {
              return A + d * V + U - VectorXd::Constant(1, std::cos(w * t));
            },
            [*this](double, const VectorXd&, double shift_V, double shift_A) -> MatrixXd {
              return MatrixXd::Constant(1, 1, 1 + d * shift_V + shift_A);
            },
            VectorXd::Constant(1, U_0), VectorXd::Zero(1)};
  }
};

// Largest true errors, and how far the estimated ones are from them, at steps and in the middle of them.
struct Estimates {
  double largest = 0, off = 0, off_between = 0;
};

Estimates estimate(const Forced& forced, double rho_inf, double dt, bool changing) {
  constexpr double kEnd = 50;
  Estimates found;
  TimeError error(oscillator(forced.d));
  Integration* run = nullptr;
  std::ostringstream options;
  options << "-ts_max_time " << kEnd << " -ts_dt " << dt << " -ts_alpha_radius " << rho_inf
          << " -snes_rtol 1e-12";
  Integration integration(forced.problem(), options.str());
  run = &integration;
  VectorXd U[2], V[2], A[2];
  int steps = 0;
  integration.at_step = [&](double t, const VectorXd& at, const VectorXd& rate) {
    if (steps++ == 0) {
      const VectorXd start = run->acceleration();
      return error.start(0, {at, rate, start});
    }
    const LastStep last = generalized_alpha_last_step(run->ts);
    U[0] = values(last.start.U), V[0] = values(last.start.V), A[0] = values(last.start.A);
    U[1] = values(last.end.U), V[1] = values(last.end.V), A[1] = values(last.end.A);
    error.follow({last.time, last.size, last.alpha_m, last.alpha_f, {U[0], V[0], A[0]}, {U[1], V[1], A[1]}},
                 false);
    const double true_error = at[0] - forced.at(t), middle = last.time + last.size / 2;
    found.largest = std::max(found.largest, std::abs(true_error));
    found.off = std::max(found.off, std::abs(error.at_end()[0] - true_error));
    const UniqueVec u = test::vector(at), v = test::vector(at), a = test::vector(at);
    ASSERT_TRUE(generalized_alpha_solve_between(run->ts, middle, {u, v, a}));
    const double between = error.within(middle, values(u))[0] - (values(u)[0] - forced.at(middle));
    found.off_between = std::max(found.off_between, std::abs(between));
    const double next = dt * (steps % 3 == 0 ? 1.4 : steps % 3 == 1 ? 1 : 0.7);
    if (changing && t < kEnd) check(TSSetTimeStep(run->ts, std::min(next, kEnd - t)));
  };
  integration.solve();
  return found;
}

TEST(TimeError, of_a_forced_oscillator_is_its_true_one) {
  constexpr double kShare = 0.05;  // of the largest error
  for (const double rho_inf : {0.0, 0.5, 0.8, 1.0})
    for (const double damping : {0.0, 0.02})
      for (const double dt : {0.02, 0.1})
        for (const bool changing : {false, true}) {
          const Estimates found = estimate({damping, 0.37, 1}, rho_inf, dt, changing);
          const testing::ScopedTrace trace(__FILE__, __LINE__,
                                           testing::Message() << rho_inf << ", " << damping << ", " << dt
                                                              << (changing ? ", changing" : ""));
          EXPECT_GT(found.largest, 1e-5);
          EXPECT_LT(found.off, kShare * found.largest);
          EXPECT_LT(found.off_between, kShare * found.largest);
        }
}

// Steps that are far too long for an oscillator leave nothing of its vibration, and the estimate says so.
TEST(TimeError, of_an_oscillator_that_steps_do_not_resolve_is_its_whole_vibration) {
  const Forced fast(0, 0.01, 2);
  const Estimates found = estimate(fast, 0.3, 4, false);
  EXPECT_GT(found.largest, 0.9);
  EXPECT_LT(found.off, 0.05);
}

// Eq. (8.22): one step from an exact motion, with A as it lags and errs in equal steps.
TEST(TimeError, local_errors_are_those_of_the_expansion) {
  constexpr double kOmega = 1.7, kTime = 0.4, kStep = 1e-3;
  const auto q = [](double t, int derivative) {
    return std::pow(kOmega, derivative) * std::cos(kOmega * t + derivative * M_PI / 2);
  };
  const auto f = [&](double t) { return q(t, 2) + q(t, 0); };
  for (const double rho_inf : {0.0, 0.5, 0.8, 1.0}) {
    const double alpha_m = (2 - rho_inf) / (1 + rho_inf), alpha_f = 1 / (1 + rho_inf),
                 lag = alpha_m - alpha_f, gamma = 0.5 + lag, beta = (1 + lag) * (1 + lag) / 4, t = kTime,
                 h = kStep, bend = q(t, 4) + q(t, 2);
    const double A_0 =
        q(t - lag * h, 2) +
        h * h * (alpha_f * (1 - alpha_f) / 2 * (q(t, 4) - bend) - alpha_m * (1 - alpha_m) / 2 * q(t, 4));
    const double U_p = q(t, 0) + h * q(t, 1) + h * h * (0.5 - beta) * A_0,
                 V_p = q(t, 1) + h * (1 - gamma) * A_0;
    const double A_1 = (f(t + alpha_f * h) - (1 - alpha_m) * A_0 - (1 - alpha_f) * q(t, 0) - alpha_f * U_p) /
                       (alpha_m + alpha_f * beta * h * h);
    const double of_U = (U_p + h * h * beta * A_1 - q(t + h, 0)) / (h * h * h),
                 of_V = (V_p + h * gamma * A_1 - q(t + h, 1)) / (h * h * h);
    const double C_U = beta - 1. / 6 - lag / 2, C_V = 1. / 12 - lag * (1 - 2 * alpha_f) / 2;
    EXPECT_NEAR(of_U, C_U * q(t, 3), 10 * h) << rho_inf;
    EXPECT_NEAR(of_V, C_V * q(t, 4) - alpha_f * (1 - alpha_f) / 2 * bend, 10 * h) << rho_inf;
  }
}

// As a run has them that ends with a step that cannot be cut any more, and goes on with other options.
TEST(TimeError, survives_steps_that_hardly_move_the_time) {
  constexpr double kTime = 2e-4, kTiny = 1e-19, kStep = 1e-6;
  const auto still = [](double noise) { return VectorXd::Constant(1, noise * 1e-10); };
  TimeError error(oscillator(0, 1e6));
  const VectorXd zero = still(0), some = still(1), more = still(2);
  error.start(kTime, {zero, zero, zero});
  for (int i = 0; i < 3; ++i)
    error.follow({kTime, kTiny, 1, 0.5, {zero, zero, i % 2 ? some : more}, {zero, zero, some}}, false);
  error.follow({kTime, kStep, 1, 0.5, {zero, zero, some}, {zero, zero, some}}, false);
  EXPECT_NEAR(error.at_end()[0], 0, 1e-20);
}

TEST(TimeError, goes_on_after_an_impulse_and_from_an_archive) {
  const VectorXd zero = VectorXd::Zero(1), one = VectorXd::Ones(1);
  TimeError error(oscillator(0.1, 4));
  error.start(0, {zero, zero, one});
  error.follow({0, 0.1, 1, 0.5, {zero, zero, zero}, {one, one, one}}, true);
  EXPECT_EQ(error.at_end()[0], 0);
  error.follow({0.1, 0.1, 1, 0.5, {one, one, one}, {one, zero, one}}, false);
  EXPECT_NE(error.at_end()[0], 0);
  Archive written;
  error.serialize(written);
  TimeError again(oscillator(0.1, 4));
  Archive read(written.numbers());
  again.serialize(read);
  read.finish();
  for (TimeError* each : {&error, &again})
    each->follow({0.2, 0.1, 1, 0.5, {one, zero, one}, {one, one, zero}}, false);
  EXPECT_EQ(error.at_end(), again.at_end());
  EXPECT_EQ(error.end_time(), again.end_time());
}

}  // namespace
}  // namespace elastogear::time_error_test
