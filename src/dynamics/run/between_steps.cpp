// Motion between the ends of the last step.
#include "dynamics/integrator/generalized_alpha_method.h"

namespace elastogear::dynamics::generalized_alpha {
namespace {

// A at the start of the last step, with the lag of a step that ends at the share s of it. Eq. (8.17a).
PetscErrorCode shorten_lag(Method& m, PetscReal s, Vec A) {
  const PetscReal weight = (m.parameters.alpha_m - m.parameters.alpha_f) * (1 - s);
  PetscCall(VecCopy(m.start.A, A));
  return weight == 0 ? 0 : VecAXPBY(A, weight, 1 - weight, m.end.A);
}

// x := the end of a step from the start of the last one to t; the method keeps its own start and end.
PetscErrorCode step_to(TS ts, PetscReal t, const Motion& x) {
  Method& m = method(ts);
  const StepContext at = context_of(ts);
  Vec A = nullptr;
  PetscCall(VecDuplicate(x.A, &A));
  PetscCall(shorten_lag(m, (t - m.step_time) / m.step_size, A));
  const Motion start = m.start, end = m.end;
  m.start.A = A;
  m.end = x;
  PetscCall(TSSetTime(ts, m.step_time));
  PetscCall(TSSetTimeStep(ts, t - m.step_time));
  const PetscErrorCode code = solve_step(ts);
  PetscCall(TSSetTime(ts, at.time));
  PetscCall(TSSetTimeStep(ts, at.step));
  m.start = start;
  m.end = end;
  PetscCall(VecDestroy(&A));
  return code;
}

}  // namespace

// Cubic Hermite polynomial through U and V at both ends of the last step, as integrated: docs/theory,
// Eq. (8.10).
PetscErrorCode interpolate(TS ts, PetscReal t, Vec U) {
  const Method& m = method(ts);
  const PetscReal dt = m.step_size, s = (t - m.step_time) / dt;
  PetscCheck(dt > 0 && m.step_time == context_of(ts).time_before, PetscObjectComm((PetscObject)ts),
             PETSC_ERR_ARG_WRONGSTATE, "No step to interpolate: none was taken, or it was rolled back");
  const PetscReal h = s * s * (3 - 2 * s);
  const PetscScalar weights[] = {1 - h, h, dt * s * (1 - s) * (1 - s), dt * s * s * (s - 1)};
  Vec ends[] = {m.start.U, m.end.U, m.start.V, m.end.V};
  PetscCall(VecZeroEntries(U));
  return VecMAXPY(U, 4, weights, ends);
}

// Derivative of the Hermite polynomial of interpolate, docs/theory, Eq. (8.17).
PetscErrorCode interpolate_velocity(TS ts, PetscReal t, Vec V) {
  const Method& m = method(ts);
  const PetscReal dt = m.step_size, s = (t - m.step_time) / dt, slope = 6 * s * (1 - s) / dt;
  const PetscScalar weights[] = {-slope, slope, (1 - s) * (1 - 3 * s), s * (3 * s - 2)};
  Vec ends[] = {m.start.U, m.end.U, m.start.V, m.end.V};
  PetscCall(VecZeroEntries(V));
  return VecMAXPY(V, 4, weights, ends);
}

// Linear between the ends of the last step, docs/theory, Eq. (8.17).
PetscErrorCode interpolate_acceleration(TS ts, PetscReal t, Vec A) {
  const Method& m = method(ts);
  const PetscReal s = (t - m.step_time) / m.step_size;
  PetscCall(VecCopy(m.start.A, A));
  return VecAXPBY(A, s, 1 - s, m.end.A);
}

PetscErrorCode solve_between(TS ts, PetscReal t, const Motion& x, bool* solved) {
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscCall(step_to(ts, t, x));
  PetscCall(SNESGetConvergedReason(context_of(ts).snes, &reason));
  *solved = reason > 0;
  return 0;
}

}  // namespace elastogear::dynamics::generalized_alpha
