#include "elastogear/dynamics/generalized_alpha.h"

#include <petsc/private/tsimpl.h>

#include <cmath>

#include "dynamics/integrator/generalized_alpha_method.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"

namespace elastogear::dynamics {
namespace {

using namespace generalized_alpha;

constexpr const char* kTypeName = "generalized_alpha";
const char* const kPredictorNames[] = {"none", "constant_acceleration", "zero_acceleration"};

// ---- the accepted state

// PETSc asks for a restart whenever the solution was merely touched, which would throw away an A that is
// still good: only changed values count, or a request without any touch (TSRestartStep, the start of
// TSSolve).
PetscErrorCode acceleration_is_known(TS ts, bool* known) {
  const Method& m = method(ts);
  PetscBool U_same = PETSC_FALSE, V_same = PETSC_FALSE;
  PetscObjectState state = 0;
  *known = false;
  if (!m.acceleration_known) return 0;
  PetscCall(VecEqual(ts->vec_sol, m.current.U, &U_same));
  PetscCall(VecEqual(ts->vec_dot, m.current.V, &V_same));
  PetscCall(PetscObjectStateGet((PetscObject)ts->vec_sol, &state));
  *known = U_same && V_same && (!ts->steprestart || state != m.solution_state);
  return 0;
}

// Fails with PETSC_ERR_NOT_CONVERGED, or with ts->reason where TSSetErrorIfStepFails is off.
PetscErrorCode acceleration_outcome(TS ts) {
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscCall(SNESGetConvergedReason(ts->snes, &reason));
  PetscCheck(
      reason >= 0 || !ts->errorifstepfailed, PetscObjectComm((PetscObject)ts), PETSC_ERR_NOT_CONVERGED,
      "No acceleration with F(t, U, V, A) = 0 at t = %g (%s): is the mass matrix singular, or the state "
      "inadmissible?",
      (double)ts->ptime, SNESConvergedReasons[reason]);
  if (reason < 0) ts->reason = TS_DIVERGED_NONLINEAR_SOLVE;
  method(ts).acceleration_known = reason >= 0;
  method(ts).last.step = 0;
  return 0;
}

PetscErrorCode ensure_acceleration(TS ts) {
  bool known = false;
  PetscCall(acceleration_is_known(ts, &known));
  if (known) return 0;
  PetscCall(solve_acceleration(ts));
  PetscCall(acceleration_outcome(ts));
  ts->steprestart = PETSC_FALSE;
  return PetscObjectStateGet((PetscObject)ts->vec_sol, &method(ts).solution_state);
}

PetscErrorCode set_solution(TS ts, const Motion& x) {
  Method& m = method(ts);
  PetscCall(copy(x, m.current));
  PetscCall(VecCopy(x.U, ts->vec_sol));
  PetscCall(VecCopy(x.V, ts->vec_dot));
  m.acceleration_known = true;
  return PetscObjectStateGet((PetscObject)ts->vec_sol, &m.solution_state);
}

// ---- one step

// One try with the present time step. A rejected one leaves the state untouched and a smaller ts->time_step.
PetscErrorCode attempt(TS ts, PetscBool* accept, PetscReal* next_step) {
  Method& m = method(ts);
  PetscBool solved = PETSC_FALSE;
  PetscCall(move_lag(ts));
  PetscCall(solve_step(ts));
  PetscCall(TSAdaptCheckStage(ts->adapt, ts, ts->ptime + ts->time_step, m.end.U, &solved));
  if (!solved) {
    *accept = PETSC_FALSE;
    return 0;
  }
  PetscCall(set_solution(ts, m.end));
  PetscCall(TSAdaptChoose(ts->adapt, ts, ts->time_step, nullptr, next_step, accept));
  if (*accept) return 0;
  PetscCall(set_solution(ts, m.start));
  PetscCall(VecCopy(m.last.A, m.current.A));
  ts->time_step = *next_step;
  return 0;
}

// A step that hardly moves the time is none, for steps after a cut may be cut again and again.
bool moves_time(TS ts) {
  constexpr double kRoundoff = 1e-13;
  return ts->time_step > kRoundoff * std::abs(ts->ptime);
}

PetscErrorCode count_rejection(TS ts, PetscInt* rejections) {
  ts->reject++;
  const bool may_go_on = ts->max_reject < 0 || ++*rejections <= ts->max_reject;
  if (ts->reason || (may_go_on && moves_time(ts))) return 0;
  ts->reason = TS_DIVERGED_STEP_REJECTED;
  return PetscInfo(ts, "step %" PetscInt_FMT " rejected %" PetscInt_FMT " times\n", ts->steps, *rejections);
}

PetscErrorCode step(TS ts) {
  Method& m = method(ts);
  PetscBool accept = PETSC_TRUE;
  PetscReal next_step = ts->time_step;
  PetscInt rejections = 0;
  PetscCall(ensure_acceleration(ts));
  PetscCall(copy(m.current, m.start));
  PetscCall(VecCopy(m.current.A, m.last.A));
  while (!ts->reason) {
    PetscCall(attempt(ts, &accept, &next_step));
    if (accept) break;
    PetscCall(count_rejection(ts, &rejections));
  }
  if (ts->reason) return 0;
  PetscCall(remember_slope(ts));
  m.step_time = ts->ptime;
  m.step_size = ts->time_step;
  ts->ptime += ts->time_step;
  ts->time_step = next_step;
  return 0;
}

PetscErrorCode roll_back(TS ts) {
  Method& m = method(ts);
  PetscCall(set_solution(ts, m.start));
  return VecCopy(m.last.A, m.current.A);
}

// ---- error estimate

// error := scale * (A1 - A0)
PetscErrorCode local_error(const Method& m, PetscReal scale, Vec error) {
  PetscCall(VecWAXPY(error, -1, m.start.A, m.end.A));
  return VecScale(error, scale);
}

// norm := weighted norm of an error of x. The vector `error` is overwritten.
PetscErrorCode error_norm(TS ts, Vec x, Vec error, NormType type, PetscReal* norm) {
  PetscReal absolute = 0, relative = 0;
  PetscCall(VecAXPY(error, 1, x));
  return TSErrorWeightedNorm(ts, x, error, type, norm, &absolute, &relative);
}

// norm := weighted norm of the error of V against tolerances of its own, because V has other units than U.
PetscErrorCode velocity_error_norm(TS ts, NormType type, PetscReal* norm) {
  const Method& m = method(ts);
  const PetscReal atol = ts->atol, rtol = ts->rtol;
  Vec vatol = m.velocity_vatol, vrtol = nullptr;
  std::swap(vatol, ts->vatol);
  std::swap(vrtol, ts->vrtol);
  ts->atol = m.velocity_atol;
  ts->rtol = m.velocity_rtol;
  const Vec error = m.at_stage.U;
  PetscErrorCode code = local_error(m, m.parameters.gamma * ts->time_step, error);
  if (!code) code = error_norm(ts, m.end.V, error, type, norm);
  ts->atol = atol;
  ts->rtol = rtol;
  std::swap(vatol, ts->vatol);
  std::swap(vrtol, ts->vrtol);
  return code;
}

// Local error of U, third order in dt, and of the predicted V, second order: docs/theory,
// Eq. (8.9).
PetscErrorCode evaluate_wlte(TS ts, NormType type, PetscInt* order, PetscReal* wlte) {
  const Method& m = method(ts);
  const Parameters& p = m.parameters;
  const PetscReal dt = ts->time_step;
  const PetscReal C_U = PetscAbsReal(position_constant(p));
  PetscReal velocity = 0, measured = 0;
  const Vec error = m.at_stage.U;  // free until the next stage
  PetscCall(local_error(m, C_U * dt * dt, error));
  if (m.measure) PetscCall(m.measure(error, &measured));
  PetscCall(error_norm(ts, m.end.U, error, type, wlte));
  if (m.velocity_vatol || m.velocity_atol > 0 || m.velocity_rtol > 0)
    PetscCall(velocity_error_norm(ts, type, &velocity));
  // The power 3/2 asks for the step that second order would.
  *wlte = PetscMax(PetscMax(*wlte, measured), PetscPowReal(velocity, 1.5));
  if (order) *order = 3;
  return 0;
}

// ---- parameters and options

PetscErrorCode set_parameters(TS ts, PetscReal alpha_m, PetscReal alpha_f, PetscReal gamma, PetscReal beta) {
  const bool finite = !PetscIsInfOrNanReal(alpha_m + alpha_f + gamma + beta);
  PetscCheck(
      finite && alpha_m > 0 && alpha_f > 0 && beta > 0, PetscObjectComm((PetscObject)ts),
      PETSC_ERR_ARG_OUTOFRANGE,
      "alpha_m %g, alpha_f %g and beta %g must be > 0 and gamma %g finite (alpha_m, alpha_f weight the new "
      "state)",
      (double)alpha_m, (double)alpha_f, (double)beta, (double)gamma);
  method(ts).parameters = {alpha_m, alpha_f, gamma, beta};
  return 0;
}

PetscErrorCode set_radius(TS ts, PetscReal rho_inf) {
  PetscCheck(rho_inf >= 0 && rho_inf <= 1, PetscObjectComm((PetscObject)ts), PETSC_ERR_ARG_OUTOFRANGE,
             "Spectral radius -ts_alpha_radius %g must be in 0..1", (double)rho_inf);
  method(ts).parameters = parameters_for(rho_inf);
  return 0;
}

PetscErrorCode get_parameters(TS ts, PetscReal* alpha_m, PetscReal* alpha_f, PetscReal* gamma,
                              PetscReal* beta) {
  const Parameters& p = method(ts).parameters;
  if (alpha_m) *alpha_m = p.alpha_m;
  if (alpha_f) *alpha_f = p.alpha_f;
  if (gamma) *gamma = p.gamma;
  if (beta) *beta = p.beta;
  return 0;
}

PetscErrorCode read_parameters(TS ts, PetscOptionItems* PetscOptionsObject) {
  PetscReal rho_inf = 1;
  PetscBool given = PETSC_FALSE;
  PetscCall(PetscOptionsReal("-ts_alpha_radius", "Spectral radius at infinite frequency", "TSAlpha2SetRadius",
                             rho_inf, &rho_inf, &given));
  if (given) PetscCall(set_radius(ts, rho_inf));
  Parameters p = method(ts).parameters;
  PetscCall(PetscOptionsReal("-ts_alpha_alpha_m", "Weight of the new A in the stage", "TSAlpha2SetParams",
                             p.alpha_m, &p.alpha_m, nullptr));
  PetscCall(PetscOptionsReal("-ts_alpha_alpha_f", "Weight of the new U, V in the stage", "TSAlpha2SetParams",
                             p.alpha_f, &p.alpha_f, nullptr));
  PetscCall(PetscOptionsReal("-ts_alpha_gamma", "Newmark's gamma", "TSAlpha2SetParams", p.gamma, &p.gamma,
                             nullptr));
  PetscCall(
      PetscOptionsReal("-ts_alpha_beta", "Newmark's beta", "TSAlpha2SetParams", p.beta, &p.beta, nullptr));
  return set_parameters(ts, p.alpha_m, p.alpha_f, p.gamma, p.beta);
}

PetscErrorCode read_velocity_tolerances(TS ts, PetscOptionItems* PetscOptionsObject) {
  Method& m = method(ts);
  PetscCall(PetscOptionsReal("-ts_alpha_velocity_rtol", "Relative tolerance of V", "TSSetTolerances",
                             m.velocity_rtol, &m.velocity_rtol, nullptr));
  PetscCall(PetscOptionsReal("-ts_alpha_velocity_atol", "Absolute tolerance of V", "TSSetTolerances",
                             m.velocity_atol, &m.velocity_atol, nullptr));
  PetscCheck(m.velocity_rtol >= 0 && m.velocity_atol >= 0, PetscObjectComm((PetscObject)ts),
             PETSC_ERR_ARG_OUTOFRANGE, "-ts_alpha_velocity_rtol %g and _atol %g must be >= 0",
             (double)m.velocity_rtol, (double)m.velocity_atol);
  return 0;
}

PetscErrorCode set_from_options(TS ts, PetscOptionItems* PetscOptionsObject) {
  Method& m = method(ts);
  auto predictor = static_cast<PetscInt>(m.predictor);
  PetscOptionsHeadBegin(PetscOptionsObject, "Generalised-alpha options");
  PetscCall(read_parameters(ts, PetscOptionsObject));
  PetscCall(read_velocity_tolerances(ts, PetscOptionsObject));
  PetscCall(PetscOptionsEList("-ts_alpha_predictor", "Start of Newton's method", "", kPredictorNames, 3,
                              kPredictorNames[predictor], &predictor, nullptr));
  PetscOptionsHeadEnd();
  m.predictor = static_cast<Predictor>(predictor);
  return 0;
}

// ---- the type

PetscErrorCode set_up(TS ts) {
  TSI2Function F = nullptr;
  DM dm = nullptr;
  const MPI_Comm comm = PetscObjectComm((PetscObject)ts);
  PetscCall(TSGetDM(ts, &dm));
  PetscCall(DMTSGetI2Function(dm, &F, nullptr));
  PetscCheck(F, comm, PETSC_ERR_ARG_WRONGSTATE, "%s needs F(t, U, V, A): call TSSetI2Function()", kTypeName);
  PetscCheck(ts->vec_dot, comm, PETSC_ERR_ARG_WRONGSTATE, "%s needs U and V: call TS2SetSolution()",
             kTypeName);
  PetscCall(TSGetAdapt(ts, &ts->adapt));
  PetscCall(TSAdaptCandidatesClear(ts->adapt));
  PetscCall(TSGetSNES(ts, &ts->snes));
  return create_vectors(ts);
}

PetscErrorCode reset(TS ts) {
  Method& m = method(ts);
  m.acceleration_known = false;
  m.step_size = 0;
  return destroy_vectors(m);
}

PetscErrorCode compose(TS ts, decltype(&set_radius) radius, decltype(&set_parameters) parameters,
                       decltype(&get_parameters) get) {
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, "TSAlpha2SetRadius_C", radius));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, "TSAlpha2SetParams_C", parameters));
  PetscCall(PetscObjectComposeFunction((PetscObject)ts, "TSAlpha2GetParams_C", get));
  return 0;
}

PetscErrorCode destroy(TS ts) {
  PetscCall(reset(ts));
  PetscCall(compose(ts, nullptr, nullptr, nullptr));
  PetscCall(VecDestroy(&method(ts).velocity_vatol));
  delete static_cast<Method*>(ts->data);
  ts->data = nullptr;
  return 0;
}

PetscErrorCode view(TS ts, PetscViewer viewer) {
  const Method& m = method(ts);
  const Parameters& p = m.parameters;
  PetscBool ascii = PETSC_FALSE;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (!ascii) return 0;
  return PetscViewerASCIIPrintf(viewer, "  alpha_m=%g, alpha_f=%g, gamma=%g, beta=%g, predictor %s\n",
                                (double)p.alpha_m, (double)p.alpha_f, (double)p.gamma, (double)p.beta,
                                kPredictorNames[static_cast<int>(m.predictor)]);
}

PetscErrorCode create(TS ts) {
  ts->ops->setup = set_up;
  ts->ops->reset = reset;
  ts->ops->destroy = destroy;
  ts->ops->view = view;
  ts->ops->setfromoptions = set_from_options;
  ts->ops->step = step;
  ts->ops->rollback = roll_back;
  ts->ops->interpolate = interpolate;
  ts->ops->evaluatewlte = evaluate_wlte;
  ts->ops->snesfunction = stage_function;
  ts->ops->snesjacobian = stage_jacobian;
  ts->default_adapt_type = TSADAPTNONE;
  ts->usessnes = PETSC_TRUE;
  ts->data = new Method{};
  method(ts).parameters = parameters_for(1);
  method(ts).predictor = Predictor::constant_acceleration;
  return compose(ts, set_radius, set_parameters, get_parameters);
}

}  // namespace

Method& generalized_alpha::method(TS ts) { return *static_cast<Method*>(ts->data); }

generalized_alpha::StepContext generalized_alpha::context_of(TS ts) {
  return {ts->vec_sol, ts->vec_dot, ts->snes, ts->ptime, ts->time_step, ts->ptime_prev};
}

PetscErrorCode generalized_alpha::count_iterations(TS ts, PetscInt newton, PetscInt linear) {
  ts->snes_its += newton;
  ts->ksp_its += linear;
  return 0;
}

Method& generalized_alpha::ready_method(TS ts) {
  TSType type = nullptr;
  check(TSGetType(ts, &type));
  require(ts->ops->step == step, "TS type ", type ? type : "(none)", ": must be ", kTypeName);
  check(TSSetUp(ts));
  return method(ts);
}

void register_generalized_alpha() { check(TSRegister(kTypeName, create)); }

void generalized_alpha_state(TS ts, Vec* U, Vec* V, Vec* A) {
  const Method& m = ready_method(ts);
  check(ensure_acceleration(ts));
  require(m.acceleration_known, "no acceleration with F(t, U, V, A) = 0 at t = ", ts->ptime);
  if (U) *U = ts->vec_sol;
  if (V) *V = ts->vec_dot;
  if (A) *A = m.current.A;
}

void generalized_alpha_set_state(TS ts, Vec U, Vec V, Vec A) {
  Method& m = ready_method(ts);
  check(set_solution(ts, {U, V, A}));
  m.solution_state = -1;
}

void generalized_alpha_interpolate(TS ts, double t, const MotionVectors& x) {
  ready_method(ts);
  check(interpolate(ts, t, x.U));
  check(interpolate_velocity(ts, t, x.V));
  check(interpolate_acceleration(ts, t, x.A));
}

bool generalized_alpha_solve_between(TS ts, double t, const MotionVectors& x) {
  bool solved = false;
  ready_method(ts);
  check(solve_between(ts, t, {x.U, x.V, x.A}, &solved));
  return solved;
}

LastStep generalized_alpha_last_step(TS ts) {
  const Method& m = ready_method(ts);
  require(m.step_size > 0, "no step has been taken");
  return {{m.start.U, m.start.V, m.start.A},
          {m.end.U, m.end.V, m.end.A},
          m.step_time,
          m.step_size,
          m.parameters.alpha_m,
          m.parameters.alpha_f};
}

void generalized_alpha_set_tolerances(TS ts, Vec scale, double position, double velocity) {
  Method& m = ready_method(ts);
  UniqueVec absolute;
  check(VecDuplicate(scale, absolute.out()));
  check(VecCopy(scale, absolute));
  check(VecScale(absolute, position));
  check(TSSetTolerances(ts, PETSC_DEFAULT, absolute, 0, nullptr));
  ts->adapt->wnormtype = NORM_INFINITY;
  check(VecDestroy(&m.velocity_vatol));
  if (velocity <= 0) return;
  check(VecDuplicate(scale, &m.velocity_vatol));
  check(VecCopy(scale, m.velocity_vatol));
  check(VecScale(m.velocity_vatol, velocity));
}

void generalized_alpha_set_measure(TS ts, const std::function<PetscErrorCode(Vec, PetscReal*)>& measure) {
  ready_method(ts).measure = measure;
}

void generalized_alpha_set_check(TS ts, const std::function<PetscErrorCode(bool*)>& check) {
  ready_method(ts).check = check;
}

void generalized_alpha_set_acceleration(TS ts, StepAcceleration acceleration) {
  Method& m = ready_method(ts);
  m.last.step = 0;
  if (acceleration == StepAcceleration::at_start) return check(VecCopy(m.start.A, m.current.A));
  check(VecWAXPY(m.current.A, -1, m.start.V, m.current.V));
  check(VecScale(m.current.A, 1 / m.step_size));
}

StepHistory generalized_alpha_history(TS ts) {
  generalized_alpha::Method& m = generalized_alpha::ready_method(ts);
  return {m.last.slope, &m.last.step};
}

void generalized_alpha_restart(TS ts) { ready_method(ts).acceleration_known = false; }

}  // namespace elastogear::dynamics
