// How the time integrator works with SNES, TS and its callers: failures, restarts, resumed runs.
#include <cmath>

#include "elastogear/base/error.h"
#include "second_order_problem.h"

namespace elastogear::generalized_alpha_control_test {
using namespace test;
namespace {

using dynamics::generalized_alpha_restart;
using dynamics::generalized_alpha_set_state;
using dynamics::generalized_alpha_state;

// Pendulum with a drive: nonlinear, damped, explicit in time. U0 is the angle at the start.
Problem driven_pendulum() {
  return {[](double t, const VectorXd& U, const VectorXd& V, const VectorXd& A) -> VectorXd {
            return VectorXd::Constant(1, A[0] + 0.1 * V[0] + std::sin(U[0]) - std::cos(2 * t));
          },
          [](double, const VectorXd& U, double shift_V, double shift_A) {
            return MatrixXd::Constant(1, 1, std::cos(U[0]) + 0.1 * shift_V + shift_A);
          },
          VectorXd::Constant(1, 1.0), VectorXd::Constant(1, 0.5)};
}

const std::string common = "-ts_alpha_radius 0.5 -snes_rtol 1e-12 ";

// Every evaluation of F in (0, `until`] declares a domain error while `failures` lasts.
struct Failing {
  int failures = 0;
  Integration* run = nullptr;

  Problem problem() {
    Problem p = driven_pendulum();
    p.F = [this, F = p.F](double t, const VectorXd& U, const VectorXd& V, const VectorXd& A) {
      if (t > 0 && failures > 0) {
        failures--;
        SNES snes = nullptr;
        check(TSGetSNES(run->ts, &snes));
        check(SNESSetFunctionDomainError(snes));
      }
      return F(t, U, V, A);
    };
    return p;
  }
};

TEST(GeneralizedAlphaFailure, repeats_a_failed_step_with_a_smaller_one) {
  Failing failing{1};
  Integration run(failing.problem(), common + "-ts_dt 0.1 -ts_max_time 2 -ts_max_snes_failures -1");
  failing.run = &run;
  run.solve();
  PetscInt rejected = 0;
  check(TSGetStepRejections(run.ts, &rejected));
  EXPECT_EQ(rejected, 1);
  Integration smaller(driven_pendulum(), common + "-ts_dt 0.025 -ts_max_time 2");
  smaller.solve();
  EXPECT_EQ(run.displacement(), smaller.displacement());
  EXPECT_EQ(run.velocity(), smaller.velocity());
}

TEST(GeneralizedAlphaFailure, ends_the_run_at_the_last_accepted_state) {
  Failing failing{1000};
  Integration run(failing.problem(), common + "-ts_dt 0.1 -ts_max_time 2 -ts_max_snes_failures 1");
  failing.run = &run;
  EXPECT_THROW(run.solve(), Error);
  EXPECT_EQ(run.displacement(), run.problem.U0);
  EXPECT_EQ(run.velocity(), run.problem.V0);
}

void expect_gives_up(Integration& run) {
  run.solve();
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetConvergedReason(run.ts, &reason));
  EXPECT_EQ(reason, TS_DIVERGED_STEP_REJECTED);
  EXPECT_EQ(run.displacement(), run.problem.U0);
  EXPECT_EQ(run.velocity(), run.problem.V0);
}

TEST(GeneralizedAlphaFailure, gives_up_after_max_reject) {
  const std::string options =
      common +
      "-ts_dt 0.1 -ts_max_time 2 -ts_max_reject 3 -ts_error_if_step_fails 0 -ts_max_snes_failures -1 ";
  Failing failing{1000};
  Integration unsolved(failing.problem(), options);
  failing.run = &unsolved;
  expect_gives_up(unsolved);
  Integration inaccurate(driven_pendulum(), options + "-ts_adapt_type basic -ts_rtol 0 -ts_atol 1e-30");
  expect_gives_up(inaccurate);
}

TEST(GeneralizedAlphaFailure, a_singular_mass_is_named) {
  Problem massless = driven_pendulum();
  massless.F = [](double, const VectorXd& U, const VectorXd&, const VectorXd&) -> VectorXd {
    return VectorXd::Constant(1, U[0] + 1);
  };
  Integration run(massless, "-ts_max_time 1");
  try {
    run.solve();
    FAIL() << "a singular mass passed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("mass"), std::string::npos) << error.what();
  }
}

// The residual at rest is roundoff of the forces and cannot fall by -snes_rtol.
TEST(GeneralizedAlphaFailure, rest_under_load_is_no_failure) {
  const Matrix2d K{{1.1e7, -0.7e7}, {-0.7e7, 1.3e7}};
  const Vector2d load = Vector2d(9.81, 1e3 / 3), rest = K.ldlt().solve(load);
  const Problem at_rest{[=](double, const VectorXd& U, const VectorXd&, const VectorXd& A) -> VectorXd {
                          return A + K * U - load;
                        },
                        [=](double, const VectorXd&, double, double shift_A) -> MatrixXd {
                          return K + shift_A * Matrix2d::Identity();
                        },
                        rest, VectorXd::Zero(2)};
  for (const std::string search : {"bt", "basic"}) {
    Integration run(at_rest, "-ts_dt 1e-3 -ts_max_time 0.1 -snes_linesearch_type " + search);
    run.solve();
    EXPECT_LT((run.displacement() - rest).norm(), 1e-12 * rest.norm());
  }
}

TEST(GeneralizedAlphaLinear, ksponly_is_right_on_a_linear_problem) {
  Problem linear = driven_pendulum();
  linear.F = [](double t, const VectorXd& U, const VectorXd& V, const VectorXd& A) -> VectorXd {
    return VectorXd::Constant(1, A[0] + 0.1 * V[0] + 4 * U[0] - std::cos(2 * t));
  };
  linear.J = [](double, const VectorXd&, double shift_V, double shift_A) {
    return MatrixXd::Constant(1, 1, 4 + 0.1 * shift_V + shift_A);
  };
  Integration once(linear, common + "-ts_dt 0.05 -ts_max_time 3", {}, TS_LINEAR);
  Integration newton(linear, common + "-ts_dt 0.05 -ts_max_time 3");
  once.solve();
  newton.solve();
  EXPECT_NEAR(once.displacement()[0], newton.displacement()[0], 1e-12);
  EXPECT_NEAR(once.velocity()[0], newton.velocity()[0], 1e-12);
}

TEST(GeneralizedAlphaLinear, ksponly_refuses_a_nonlinear_problem) {
  Integration run(driven_pendulum(), "-ts_dt 0.5 -ts_max_time 3 -snes_type ksponly");
  try {
    run.solve();
    FAIL() << "one linear solve passed as a solution";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("-snes_type newtonls"), std::string::npos) << error.what();
  }
}

TEST(GeneralizedAlphaState, rolls_back_a_step) {
  Integration run(driven_pendulum(), common + "-ts_dt 0.1 -ts_max_time 2");
  check(TSStep(run.ts));
  check(TSStep(run.ts));
  const VectorXd U = run.displacement(), V = run.velocity(), A = run.acceleration();
  check(TSRollBack(run.ts));
  EXPECT_NE(run.displacement(), U);
  const UniqueVec between = vector(U);
  EXPECT_NE(TSInterpolate(run.ts, 0.1, between), 0);
  check(TSStep(run.ts));
  EXPECT_NEAR((run.displacement() - U).norm(), 0, 1e-14);
  EXPECT_NEAR((run.velocity() - V).norm(), 0, 1e-13);
  EXPECT_NEAR((run.acceleration() - A).norm(), 0, 1e-12);
}

void expect_resumes_bit_for_bit(const std::string& options) {
  Integration whole(driven_pendulum(), common + options + " -ts_max_time 4");
  whole.solve();

  Integration first(driven_pendulum(), common + options + " -ts_max_time 4 -ts_max_steps 15");
  first.solve();
  PetscReal t = 0, dt = 0;
  check(TSGetTime(first.ts, &t));
  check(TSGetTimeStep(first.ts, &dt));

  Integration second(driven_pendulum(), common + options + " -ts_max_time 4");
  check(TSSetTime(second.ts, t));
  check(TSSetTimeStep(second.ts, dt));
  check(TSSetStepNumber(second.ts, 15));
  generalized_alpha_set_state(second.ts, vector(first.displacement()), vector(first.velocity()),
                              vector(first.acceleration()));
  const dynamics::StepHistory from = dynamics::generalized_alpha_history(first.ts),
                              to = dynamics::generalized_alpha_history(second.ts);
  set_values(to.slope, values(from.slope));
  *to.step = *from.step;
  second.solve();
  EXPECT_EQ(second.displacement(), whole.displacement());
  EXPECT_EQ(second.velocity(), whole.velocity());
  EXPECT_EQ(second.acceleration(), whole.acceleration());
}

TEST(GeneralizedAlphaState, resumes_bit_for_bit) {
  expect_resumes_bit_for_bit("-ts_dt 0.05");
  expect_resumes_bit_for_bit(
      "-ts_dt 0.01 -ts_adapt_type basic -ts_rtol 0 -ts_atol 1e-5 -ts_alpha_velocity_atol 1e-3");
}

TEST(GeneralizedAlphaState, reading_it_changes_nothing) {
  Integration plain(driven_pendulum(), common + "-ts_dt 0.05 -ts_max_time 2");
  plain.solve();
  Integration* self = nullptr;
  Integration watched(driven_pendulum(), common + "-ts_dt 0.05 -ts_max_time 2",
                      [&](double, const VectorXd&, const VectorXd&) { self->acceleration(); });
  self = &watched;
  check(TSSetPostStep(watched.ts, [](TS ts) -> PetscErrorCode {  // touched, not changed
    Vec U = nullptr;
    PetscScalar* a = nullptr;
    PetscCall(TSGetSolution(ts, &U));
    PetscCall(VecGetArray(U, &a));
    return VecRestoreArray(U, &a);
  }));
  watched.solve();
  EXPECT_EQ(plain.displacement(), watched.displacement());
  EXPECT_EQ(plain.velocity(), watched.velocity());
}

// A wheel turned by a torque that depends on the angle with period 2 pi.
TEST(GeneralizedAlphaState, coordinates_can_be_rebased_after_every_step) {
  const double turn = 2 * std::acos(-1.);
  Problem spinning = driven_pendulum();
  spinning.V0[0] = 40;
  Integration plain(spinning, common + "-ts_dt 0.02 -ts_max_time 2"),
      rebased(spinning, common + "-ts_dt 0.02 -ts_max_time 2");
  check(TSSetPostStep(rebased.ts, [](TS ts) -> PetscErrorCode {
    Vec U = nullptr, V = nullptr, A = nullptr;
    generalized_alpha_state(ts, &U, &V, &A);
    PetscCall(VecShift(U, -2 * std::acos(-1.) * std::floor(values(U)[0] / (2 * std::acos(-1.)))));
    generalized_alpha_set_state(ts, U, V, A);
    return 0;
  }));
  plain.solve();
  rebased.solve();
  EXPECT_LT(rebased.displacement()[0], turn);
  EXPECT_GT(plain.displacement()[0], 10 * turn);
  EXPECT_NEAR(std::remainder(plain.displacement()[0] - rebased.displacement()[0], turn), 0, 1e-10);
  EXPECT_NEAR(plain.velocity()[0], rebased.velocity()[0], 1e-10);
  EXPECT_NEAR(plain.acceleration()[0], rebased.acceleration()[0], 1e-8);
}

TEST(GeneralizedAlphaState, a_changed_velocity_restarts_the_acceleration) {
  Integration run(driven_pendulum(), common + "-ts_dt 0.1 -ts_max_time 2 -ts_max_steps 5");
  run.solve();
  const double before = run.acceleration()[0];
  check(VecScale(run.V, -1));
  PetscReal t = 0;
  check(TSGetTime(run.ts, &t));
  const double expected = std::cos(2 * t) - std::sin(run.displacement()[0]) - 0.1 * run.velocity()[0];
  EXPECT_NEAR(run.acceleration()[0], expected, 1e-12);
  EXPECT_GT(std::abs(before - expected), 1e-3);
}

TEST(GeneralizedAlphaState, a_restart_solves_the_acceleration_anew) {
  Integration run(driven_pendulum(), common + "-ts_dt 0.1 -ts_max_time 2 -ts_max_steps 5");
  run.solve();
  const VectorXd U = run.displacement(), V = run.velocity();
  const double algorithmic = run.acceleration()[0];
  PetscReal t = 0;
  check(TSGetTime(run.ts, &t));
  const double consistent = std::cos(2 * t) - std::sin(U[0]) - 0.1 * V[0];
  EXPECT_GT(std::abs(algorithmic - consistent), 1e-3);  // A of the method lags behind for rho_inf < 1
  generalized_alpha_restart(run.ts);
  EXPECT_NEAR(run.acceleration()[0], consistent, 1e-12);
}

// ---- a shell Jacobian whose preconditioner is the exact inverse for the shifts it was given

struct Diagonal {
  VectorXd mass, stiffness, value;
};

PetscErrorCode diagonal_multiply(Mat J, Vec x, Vec y) {
  Diagonal* d = nullptr;
  PetscCall(MatShellGetContext(J, &d));
  set_values(y, d->value.cwiseProduct(values(x)));
  return 0;
}

PetscErrorCode diagonal_divide(PC pc, Vec x, Vec y) {
  Diagonal* d = nullptr;
  PetscCall(PCShellGetContext(pc, &d));
  set_values(y, values(x).cwiseQuotient(d->value));
  return 0;
}

PetscErrorCode diagonal_jacobian(TS, PetscReal, Vec, Vec, Vec, PetscReal, PetscReal shift_A, Mat, Mat,
                                 void* context) {
  auto* d = static_cast<Diagonal*>(context);
  d->value = d->stiffness + shift_A * d->mass;
  return 0;
}

TEST(GeneralizedAlphaShell, an_exact_preconditioner_keyed_on_the_shifts_needs_one_iteration) {
  Diagonal d{Vector2d(2, 1e-3), Vector2d(3, 1e9), {}};
  const Problem modes{[&](double, const VectorXd& U, const VectorXd&, const VectorXd& A) -> VectorXd {
                        return d.mass.cwiseProduct(A) + d.stiffness.cwiseProduct(U);
                      },
                      {},
                      Vector2d(1, 1e-6),
                      Vector2d(0, 1)};
  Integration run(modes, "-ts_dt 1e-3 -ts_max_time 0.1 -ksp_type preonly -pc_type shell");
  UniqueMat shell;
  check(MatCreateShell(PETSC_COMM_SELF, 2, 2, 2, 2, &d, shell.out()));
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<void (*)(void)>(diagonal_multiply)));
  check(TSSetI2Jacobian(run.ts, shell, shell, diagonal_jacobian, &d));
  SNES snes = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(TSGetSNES(run.ts, &snes));
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(PCShellSetContext(pc, &d));
  check(PCShellSetApply(pc, diagonal_divide));
  EXPECT_NEAR(run.acceleration()[0], -1.5, 1e-12);
  EXPECT_NEAR(run.acceleration()[1], -1e6, 1e-12 * 1e6);
  run.solve();
  PetscInt newton = 0, steps = 0;
  check(TSGetSNESIterations(run.ts, &newton));
  check(TSGetStepNumber(run.ts, &steps));
  EXPECT_LE(newton, steps + 2);
}

TEST(GeneralizedAlphaErrors, another_type_or_a_missing_part_is_named) {
  Integration euler(driven_pendulum(), "-ts_type beuler");
  EXPECT_THROW(generalized_alpha_restart(euler.ts), Error);
  UniqueTS empty;
  check(TSCreate(PETSC_COMM_SELF, empty.out()));
  check(TSSetType(empty, "generalized_alpha"));
  EXPECT_THROW(generalized_alpha_restart(empty), Error);
}

}  // namespace
}  // namespace elastogear::generalized_alpha_control_test
