// Errors of steps that the time integrator takes out of coordinates: docs/theory.md, section 8.3.
#include <cmath>
#include <sstream>

#include "second_order_problem.h"

namespace elastogear::local_extrapolation_test {
using namespace test;
namespace {

constexpr double kEnd = 20;

// U'' + 2 xi U' + U = 0 from U = 1, U' = 0, twice.
Problem twins(double xi) {
  return {[xi](double, const VectorXd& U, const VectorXd& V, const VectorXd& A) -> VectorXd {
            return A + 2 * xi * V + U;
          },
          [xi](double, const VectorXd&, double shift_V, double shift_A) -> MatrixXd {
            return (1 + 2 * xi * shift_V + shift_A) * Matrix2d::Identity();
          },
          Vector2d(1, 1), Vector2d::Zero()};
}

// U and U' at t.
Vector2d exact(double xi, double t) {
  const double omega = std::sqrt(1 - xi * xi), left = std::exp(-xi * t), sine = std::sin(omega * t) / omega;
  return {left * (std::cos(omega * t) + xi * sine), -left * sine};
}

struct Outcome {
  Vector2d error, velocity_error;  // of the extrapolated entry and the other
  double energy = 0;
};

// Steps of h and `ratio` times h by turns; `tolerance` is that of U.
Outcome integrate(double h, double rho_inf, double ratio = 1, double tolerance = 1e-12, double xi = 0) {
  std::ostringstream options;
  options.precision(17);
  options << "-ts_dt " << h << " -ts_max_time " << kEnd << " -snes_rtol 1e-14 -ts_alpha_radius " << rho_inf;
  Integration* run = nullptr;
  int n = 0;
  Integration integration(twins(xi), options.str(), [&](double t, const VectorXd&, const VectorXd&) {
    if (run && t < kEnd) check(TSSetTimeStep(run->ts, std::min(++n % 2 ? ratio * h : h, kEnd - t)));
  });
  run = &integration;
  dynamics::generalized_alpha_extrapolate(integration.ts, test::vector(Vector2d(1, 0)));
  dynamics::generalized_alpha_set_tolerances(integration.ts, test::vector(Vector2d(1, 1)), tolerance, 0);
  integration.solve();
  const VectorXd U = integration.displacement(), V = integration.velocity();
  Outcome outcome;
  outcome.error = (U.array() - exact(xi, kEnd)[0]).abs();
  outcome.velocity_error = (V.array() - exact(xi, kEnd)[1]).abs();
  outcome.energy = U[0] * U[0] + V[0] * V[0];
  return outcome;
}

TEST(LocalExtrapolation, raises_the_order_of_a_vibration) {
  for (const double xi : {0.0, 0.03})
    for (const double rho_inf : {0.5, 0.8, 0.95}) {
      const Outcome coarse = integrate(0.2, rho_inf, 1, 1e-12, xi),
                    fine = integrate(0.1, rho_inf, 1, 1e-12, xi);
      EXPECT_NEAR(std::log2(coarse.error[1] / fine.error[1]), 2, 0.1) << rho_inf;
      EXPECT_GT(std::log2(coarse.error[0] / fine.error[0]), 2.9) << rho_inf;
      EXPECT_LT(fine.error[0], fine.error[1] / 20) << rho_inf;
      EXPECT_LT(coarse.velocity_error[0], coarse.velocity_error[1] / 3) << rho_inf;
    }
}

TEST(LocalExtrapolation, gains_where_steps_change) {
  for (const double rho_inf : {0.5, 0.8, 0.95})
    for (const double ratio : {0.5, 0.8}) {
      const Outcome changing = integrate(0.2, rho_inf, ratio);
      EXPECT_LT(changing.error[0], changing.error[1] / 5) << rho_inf << ", " << ratio;
    }
}

TEST(LocalExtrapolation, damps_rather_than_excites_what_steps_resolve) {
  for (const double h : {0.05, 0.2, 0.3, 0.4})
    for (const double rho_inf : {0.0, 0.5, 0.8, 0.95}) EXPECT_LT(integrate(h, rho_inf).energy, 1 + 1e-5) << h;
}

TEST(LocalExtrapolation, leaves_errors_that_are_small_beside_the_tolerance) {
  const Outcome left = integrate(0.1, 0.8, 1, 1);
  EXPECT_NEAR(left.error[0], left.error[1], 1e-3 * left.error[1]);
  EXPECT_NEAR(left.velocity_error[0], left.velocity_error[1], 1e-3 * left.velocity_error[1]);
}

TEST(LocalExtrapolation, has_no_part_in_a_method_that_conserves_energy) {
  const Outcome conserved = integrate(0.1, 1);
  EXPECT_EQ(conserved.error[0], conserved.error[1]);
  EXPECT_EQ(conserved.velocity_error[0], conserved.velocity_error[1]);
}

// A constant force on a free mass, whose coordinate is extrapolated, and on it a spring with a mass of its
// own.
Problem mass_with_spring() {
  const Matrix2d M = (Matrix2d() << 2, 1, 1, 1).finished(), K = Vector2d(0, 400).asDiagonal();
  return {[=](double, const VectorXd& U, const VectorXd&, const VectorXd& A) -> VectorXd {
            return M * A + K * U - Vector2d(1, 0);
          },
          [=](double, const VectorXd&, double, double shift_A) -> MatrixXd { return K + shift_A * M; },
          Vector2d::Zero(), Vector2d::Zero()};
}

TEST(LocalExtrapolation, leaves_the_momentum_to_the_forces) {
  constexpr double kForce = 1;
  Integration* run = nullptr;
  int n = 0;
  Integration integration(mass_with_spring(),
                          "-ts_dt 0.01 -ts_max_time 1 -snes_rtol 1e-14 -ts_alpha_radius 0.8",
                          [&](double t, const VectorXd&, const VectorXd& V) {
                            EXPECT_NEAR(2 * V[0] + V[1], kForce * t, 1e-12);
                            if (run && t < 1)
                              check(TSSetTimeStep(run->ts, std::min(0.01 + 0.01 * (++n % 3), 1 - t)));
                          });
  run = &integration;
  dynamics::generalized_alpha_extrapolate(integration.ts, test::vector(Vector2d(1, 0)));
  dynamics::generalized_alpha_set_tolerances(integration.ts, test::vector(Vector2d(1, 1)), 1e-5, 0);
  integration.solve();
  EXPECT_GT(n, 30);
}

// Sets tolerances and lets PETSc choose the steps.
PetscInt steps_chosen(const Vector2d& entries, double tolerance) {
  Integration run(twins(0), "-ts_dt 1e-3 -ts_max_time 20 -ts_adapt_type basic -ts_alpha_radius 0.8");
  dynamics::generalized_alpha_extrapolate(run.ts, test::vector(entries));
  dynamics::generalized_alpha_set_tolerances(run.ts, test::vector(Vector2d(1, 1)), tolerance, 0);
  run.solve();
  PetscInt steps = 0;
  check(TSGetStepNumber(run.ts, &steps));
  return steps;
}

// An error of the fourth order asks for ten to the fourth part of the steps, one of the third for the third.
TEST(LocalExtrapolation, is_counted_by_the_control_of_steps) {
  const Vector2d both(1, 1), one(1, 0);
  EXPECT_NEAR(double(steps_chosen(both, 1e-9)) / double(steps_chosen(both, 1e-8)), std::pow(10, 1. / 4), 0.1);
  EXPECT_NEAR(double(steps_chosen(one, 1e-8)) / double(steps_chosen(one, 1e-7)), std::cbrt(10), 0.1);
  EXPECT_LT(2 * steps_chosen(both, 1e-8), steps_chosen(one, 1e-8));
}

}  // namespace
}  // namespace elastogear::local_extrapolation_test
