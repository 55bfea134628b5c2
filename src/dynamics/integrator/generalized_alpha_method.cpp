#include "dynamics/integrator/generalized_alpha_method.h"

namespace elastogear::dynamics::generalized_alpha {
namespace {

// Updates below this part of the state are roundoff: Newton cannot do better and has converged.
constexpr PetscReal kRoundoff = 1e4 * PETSC_MACHINE_EPSILON;

PetscErrorCode duplicate(Vec like, Motion& x) {
  PetscCall(VecDuplicate(like, &x.U));
  PetscCall(VecDuplicate(like, &x.V));
  PetscCall(VecDuplicate(like, &x.A));
  return 0;
}

PetscErrorCode destroy(Motion& x) {
  PetscCall(VecDestroy(&x.U));
  PetscCall(VecDestroy(&x.V));
  PetscCall(VecDestroy(&x.A));
  return 0;
}

// Newmark's formulas, docs/theory, Eq. (8.3): U, V at the end of a step from its start and the
// acceleration at the end.
PetscErrorCode newmark(const Parameters& p, PetscReal dt, const Motion& start, const Motion& end) {
  PetscCall(VecCopy(start.V, end.V));
  PetscCall(VecAXPY(end.V, dt * (1 - p.gamma), start.A));
  PetscCall(VecAXPY(end.V, dt * p.gamma, end.A));
  PetscCall(VecWAXPY(end.U, dt, start.V, start.U));
  PetscCall(VecAXPY(end.U, dt * dt * (0.5 - p.beta), start.A));
  PetscCall(VecAXPY(end.U, dt * dt * p.beta, end.A));
  return 0;
}

PetscErrorCode predict(Method& m, PetscReal dt) {
  const PetscReal beta = m.parameters.beta;
  PetscCall(VecZeroEntries(m.end.A));
  if (m.predictor == Predictor::constant_acceleration) PetscCall(VecCopy(m.start.A, m.end.A));
  if (m.predictor == Predictor::none) {  // the acceleration that leaves U where it is
    PetscCall(VecAXPY(m.end.A, -1 / (beta * dt), m.start.V));
    PetscCall(VecAXPY(m.end.A, 1 - 1 / (2 * beta), m.start.A));
  }
  return newmark(m.parameters, dt, m.start, m.end);
}

// y := (1 - alpha) a + alpha b
PetscErrorCode blend(PetscReal alpha, Vec a, Vec b, Vec y) {
  PetscCall(VecCopy(a, y));
  PetscCall(VecAXPBY(y, alpha, 1 - alpha, b));
  return 0;
}

// The stage between both ends of the step: docs/theory, Eqs. (8.2) and (8.6).
PetscErrorCode set_stage(TS ts) {
  Method& m = method(ts);
  const Parameters& p = m.parameters;
  const StepContext at = context_of(ts);
  const PetscReal dt = at.step, V_per_U = p.gamma / (p.beta * dt), A_per_U = 1 / (p.beta * dt * dt);
  m.stage = {.t = at.time + p.alpha_f * dt,
             .c_U = p.alpha_f,
             .c_V = p.alpha_f * V_per_U,
             .c_A = p.alpha_m * A_per_U,
             .shift_V = V_per_U,
             .shift_A = p.alpha_m / p.alpha_f * A_per_U,
             .scale = 1 / p.alpha_f};
  PetscCall(blend(p.alpha_f, m.start.U, m.end.U, m.base.U));
  PetscCall(blend(p.alpha_f, m.start.V, m.end.V, m.base.V));
  PetscCall(blend(p.alpha_m, m.start.A, m.end.A, m.base.A));
  return 0;
}

// end += its change with Delta
PetscErrorCode correct(Method& m, PetscReal dt) {
  const Parameters& p = m.parameters;
  PetscCall(VecAXPY(m.end.U, 1, m.Delta));
  PetscCall(VecAXPY(m.end.V, p.gamma / (p.beta * dt), m.Delta));
  PetscCall(VecAXPY(m.end.A, 1 / (p.beta * dt * dt), m.Delta));
  return 0;
}

// Is SNES's last update below what the state x resolves?
PetscErrorCode update_is_roundoff(TS ts, const Motion& x, bool* is_roundoff) {
  const StepContext at = context_of(ts);
  Vec update = nullptr;
  PetscReal size = 0, U = 0, V = 0, A = 0;
  const PetscReal dt = at.step;
  PetscCall(SNESGetSolutionUpdate(at.snes, &update));
  if (update) PetscCall(VecNorm(update, NORM_2, &size));
  PetscCall(VecNorm(x.U, NORM_2, &U));
  PetscCall(VecNorm(x.V, NORM_2, &V));
  PetscCall(VecNorm(x.A, NORM_2, &A));
  *is_roundoff = update && method(ts).stage.c_A * dt * dt * size <= kRoundoff * (U + dt * V + dt * dt * A);
  return 0;
}

// A residual that is all roundoff (rest, uniform motion) cannot fall by -snes_rtol: SNES calls that a
// failure.
PetscErrorCode accept_roundoff(TS ts, const Motion& x) {
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  bool is_roundoff = false;
  PetscCall(SNESGetConvergedReason(context_of(ts).snes, &reason));
  if (reason != SNES_DIVERGED_LINE_SEARCH && reason != SNES_DIVERGED_LOCAL_MIN &&
      reason != SNES_DIVERGED_MAX_IT)
    return 0;
  PetscCall(update_is_roundoff(ts, x, &is_roundoff));
  if (is_roundoff) PetscCall(SNESSetConvergedReason(context_of(ts).snes, SNES_CONVERGED_SNORM_RELATIVE));
  return 0;
}

PetscErrorCode move_to_stage(Method& m, Vec Delta) {
  PetscCall(VecWAXPY(m.at_stage.U, m.stage.c_U, Delta, m.base.U));
  PetscCall(VecWAXPY(m.at_stage.V, m.stage.c_V, Delta, m.base.V));
  PetscCall(VecWAXPY(m.at_stage.A, m.stage.c_A, Delta, m.base.A));
  return 0;
}

PetscErrorCode residual_norm(TS ts, PetscReal* norm) {
  Method& m = method(ts);
  PetscCall(SNESComputeFunction(context_of(ts).snes, m.Delta, m.residual));
  PetscCall(VecNorm(m.residual, NORM_2, norm));
  return 0;
}

// SNESKSPONLY never looks at the residual it leaves. before: the one it found.
PetscErrorCode require_solved(TS ts, const Motion& x, PetscReal before) {
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscReal after = 0, rtol = 0, atol = 0;
  bool is_roundoff = false;
  PetscCall(SNESGetConvergedReason(context_of(ts).snes, &reason));
  if (reason < 0) return 0;
  PetscCall(residual_norm(ts, &after));
  PetscCall(SNESGetTolerances(context_of(ts).snes, &atol, &rtol, nullptr, nullptr, nullptr));
  PetscCall(update_is_roundoff(ts, x, &is_roundoff));
  PetscCheck(
      after <= PetscMax(atol, rtol * before) || is_roundoff, PetscObjectComm((PetscObject)ts),
      PETSC_ERR_NOT_CONVERGED,
      "One linear solve (SNESKSPONLY) reduced the residual only from %g to %g, not by -snes_rtol %g: the "
      "problem is not linear, or the linear solver is too inexact. Use -snes_type newtonls "
      "(TSSetProblemType TS_NONLINEAR), or lower -ksp_rtol",
      (double)before, (double)after, (double)rtol);
  return 0;
}

PetscErrorCode solve_for_delta(TS ts) {
  const SNES snes = context_of(ts).snes;
  PetscInt newton = 0, linear = 0;
  PetscCall(SNESSolve(snes, nullptr, method(ts).Delta));
  PetscCall(SNESGetIterationNumber(snes, &newton));
  PetscCall(SNESGetLinearSolveIterations(snes, &linear));
  return count_iterations(ts, newton, linear);
}

// Solves again while F changes with its solution. One that alternates is not solved.
PetscErrorCode solve_until_settled(TS ts) {
  constexpr int kMostRounds = 30;
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  for (int round = 0; round < kMostRounds; ++round) {
    bool changed = false;
    PetscCall(SNESGetConvergedReason(context_of(ts).snes, &reason));
    if (reason > 0) PetscCall(method(ts).check(&changed));
    if (!changed) return 0;
    PetscCall(solve_for_delta(ts));
  }
  return SNESSetConvergedReason(context_of(ts).snes, SNES_DIVERGED_MAX_IT);
}

// Delta := solution at the current stage; x: the state it changes, for its size.
template <class Apply>
PetscErrorCode solve(TS ts, const Motion& x, const Apply& apply) {
  Method& m = method(ts);
  PetscBool single = PETSC_FALSE;
  PetscReal before = 0;
  PetscCall(PetscObjectTypeCompare((PetscObject)context_of(ts).snes, SNESKSPONLY, &single));
  PetscCall(VecZeroEntries(m.Delta));
  if (single) {
    PetscCall(residual_norm(ts, &before));
    PetscCall(SNESSetInitialFunction(context_of(ts).snes, m.residual));
  }
  PetscCall(solve_for_delta(ts));
  if (m.check && m.stage.c_U != 0) PetscCall(solve_until_settled(ts));
  PetscCall(move_to_stage(m, m.Delta));
  PetscCall(apply());
  PetscCall(accept_roundoff(ts, x));
  if (single) PetscCall(require_solved(ts, x, before));
  return 0;
}

}  // namespace

Parameters parameters_for(PetscReal rho_inf) {
  const PetscReal alpha_m = (2 - rho_inf) / (1 + rho_inf), alpha_f = 1 / (1 + rho_inf);
  const PetscReal lag = alpha_m - alpha_f;
  return {alpha_m, alpha_f, 0.5 + lag, (1 + lag) * (1 + lag) / 4};
}

PetscErrorCode create_vectors(TS ts) {
  Method& m = method(ts);
  const StepContext at = context_of(ts);
  for (Motion* x : {&m.current, &m.start, &m.end, &m.base, &m.at_stage}) PetscCall(duplicate(at.U, *x));
  PetscCall(VecDuplicate(at.U, &m.Delta));
  PetscCall(VecDuplicate(at.U, &m.residual));
  PetscCall(VecDuplicate(at.U, &m.last.A));
  PetscCall(VecDuplicate(at.U, &m.last.slope));
  return 0;
}

PetscErrorCode destroy_vectors(Method& m) {
  for (Motion* x : {&m.current, &m.start, &m.end, &m.base, &m.at_stage}) PetscCall(destroy(*x));
  PetscCall(VecDestroy(&m.Delta));
  PetscCall(VecDestroy(&m.residual));
  PetscCall(VecDestroy(&m.last.A));
  PetscCall(VecDestroy(&m.last.slope));
  return 0;
}

PetscErrorCode copy(const Motion& from, const Motion& to) {
  PetscCall(VecCopy(from.U, to.U));
  PetscCall(VecCopy(from.V, to.V));
  PetscCall(VecCopy(from.A, to.A));
  return 0;
}

PetscErrorCode solve_step(TS ts) {
  Method& m = method(ts);
  const PetscReal dt = context_of(ts).step;
  PetscCall(predict(m, dt));
  PetscCall(set_stage(ts));
  PetscCall(TSPreStage(ts, m.stage.t));
  PetscCall(solve(ts, m.end, [&] { return correct(m, dt); }));
  PetscCall(TSPostStage(ts, m.stage.t, 0, &m.at_stage.U));
  return 0;
}

PetscErrorCode solve_acceleration(TS ts) {
  Method& m = method(ts);
  m.acceleration_known = false;
  // Shifted so far, K + shift_A M is a multiple of M to roundoff for any frequency below 1 / (epsilon dt).
  // Delta = A / c_A stays within the absolute limits of line searches and linear solvers.
  const StepContext at = context_of(ts);
  const PetscReal epsilon = PETSC_MACHINE_EPSILON, c_A = 1 / (epsilon * at.step * at.step);
  m.stage = {.t = at.time,
             .c_U = 0,
             .c_V = 0,
             .c_A = c_A,
             .shift_V = 0,
             .shift_A = c_A / epsilon,
             .scale = 1 / epsilon};
  PetscCall(VecCopy(at.U, m.current.U));
  PetscCall(VecCopy(at.V, m.current.V));
  PetscCall(VecZeroEntries(m.current.A));
  PetscCall(copy(m.current, m.base));
  return solve(ts, m.current, [&] { return VecAXPY(m.current.A, c_A, m.Delta); });
}

PetscErrorCode move_lag(TS ts) {
  const Method& m = method(ts);
  const SlopeHistory& last = m.last;
  PetscCall(VecCopy(last.A, m.start.A));
  if (last.step == 0) return 0;
  const PetscReal dt = context_of(ts).step;
  const PetscReal lag = m.parameters.alpha_m - m.parameters.alpha_f;
  const PetscReal weight = PetscMin(1, lag * (dt / last.step - 1));
  return VecAXPY(m.start.A, -weight * last.step, last.slope);
}

PetscErrorCode find_slope(TS ts, Vec slope) {
  const Method& m = method(ts);
  const PetscReal dt = context_of(ts).step;
  PetscCall(VecWAXPY(slope, -1, m.start.A, m.end.A));
  return VecScale(slope, 1 / dt);
}

PetscErrorCode remember_slope(TS ts) {
  Method& m = method(ts);
  m.last.step = context_of(ts).step;
  return find_slope(ts, m.last.slope);
}

PetscErrorCode stage_function(SNES, Vec Delta, Vec F, TS ts) {
  Method& m = method(ts);
  const Motion& x = m.at_stage;
  PetscCall(move_to_stage(m, Delta));
  PetscCall(TSComputeI2Function(ts, m.stage.t, x.U, x.V, x.A, F));
  PetscCall(VecScale(F, m.stage.scale));
  return 0;
}

PetscErrorCode stage_jacobian(SNES, Vec Delta, Mat J, Mat P, TS ts) {
  Method& m = method(ts);
  const Motion& x = m.at_stage;
  PetscCall(move_to_stage(m, Delta));  // a line search may have looked elsewhere last
  PetscCall(TSComputeI2Jacobian(ts, m.stage.t, x.U, x.V, x.A, m.stage.shift_V, m.stage.shift_A, J, P));
  return 0;
}

}  // namespace elastogear::dynamics::generalized_alpha
