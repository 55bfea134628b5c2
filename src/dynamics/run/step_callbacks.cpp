// Functions that PETSc's time stepper calls at steps and stages of a run.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace {

// Keeps the state that a step begins with, for the case that the step is given up. Only long steps are given
// up, and only then is the state copied.
void remember_step(Run& run, TS ts) {
  const bool first = run.step_start == run.start;
  const bool takes_long = first || seconds_since(run.step_start) >= run.checkpoints.patience;
  run.step_state.clear();
  if (run.checkpoints.keep && run.checkpoints.stop && takes_long) run.step_state = state_now(run, ts);
  run.step_start = Clock::now();
}

// How far a relaxing run has come, by the orders of magnitude that the unbalanced forces have fallen.
double relaxed_share(const Run& run) {
  const double wanted = std::log(std::min(0.1, run.settings.rest_tolerance));
  return std::clamp(std::log(run.least_unbalanced) / wanted, 0.0, 0.99);
}

// After everything else that happens between two steps.
void keep_if_due(Run& run, TS ts, PetscReal time) {
  PetscReal end = 0;
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetMaxTime(ts, &end));
  check(TSGetConvergedReason(ts, &reason));
  const bool stopped = reason == TS_CONVERGED_USER || is_out_of_steps(ts),
             goes_on = reason == TS_CONVERGED_ITERATING && time < end;
  if (run.settings.relax)
    report(run.progress, "relax", goes_on || stopped ? relaxed_share(run) : 1);
  else
    report(run.progress, "simulate", goes_on || stopped ? time / end : 1);
  if (stopped || (goes_on && seconds_since(run.kept) >= run.checkpoints.every)) keep_state(run, ts);
  if (goes_on) remember_step(run, ts);
}

PetscErrorCode monitor(TS ts, PetscInt step, PetscReal time, Vec, void* ctx) {
  auto& run = *static_cast<Run*>(ctx);
  if (step == run.entered_step) return 0;  // before the run was interrupted, or before a step that failed
  run.entered_step = static_cast<int>(step);
  return guard(run.problem.pending, [&] {
    enter_step(run, ts, step, time);
    report_step(run, ts, step);
    keep_if_due(run, ts, time);
  });
}

bool has_fixed_steps(TS ts) {
  TSAdapt adapt = nullptr;
  PetscBool fixed = PETSC_FALSE;
  check(TSGetAdapt(ts, &adapt));
  check(PetscObjectTypeCompare((PetscObject)adapt, TSADAPTNONE, &fixed));
  return fixed;
}

// Throws Error when steps stay far below the nominal one: the motion is too fast for it, and the run would
// take that much longer than planned.
void require_long_steps(Run& run, TS ts) {
  constexpr double kShort = 1. / 64;  // of the nominal step
  constexpr int kMostShort = 2000;
  PetscReal time = 0, before = 0;
  check(TSGetTime(ts, &time));
  check(TSGetPrevTime(ts, &before));
  const double dt = time - before;
  const bool is_short = has_fixed_steps(ts) && dt < kShort * run.nominal_dt;
  run.short_steps = is_short ? run.short_steps + 1 : 0;
  run.longest_short = is_short ? std::max(run.longest_short, dt) : 0;
  require(run.short_steps < kMostShort, "at t = ", time, " s: none of the last ", kMostShort,
          " steps could be longer than ", run.longest_short, " s, where -ts_dt = ", run.nominal_dt,
          " s was asked for: something moves too fast for it. Are speeds, loads and stiffness those that "
          "were meant? "
          "If so, take -ts_dt ",
          run.longest_short);
}

// Without an error estimate nothing would lengthen a step again that Newton's failure has cut.
PetscErrorCode recover_dt(TS ts) {
  Run* run = nullptr;
  PetscReal time = 0, end = 0, dt = 0;
  PetscInt rejected = 0;
  PetscCall(TSGetApplicationContext(ts, &run));
  PetscCall(TSGetStepRejections(ts, &rejected));
  rejected += run->summary.rejected_steps;
  PetscCall(TSGetTime(ts, &time));
  PetscCall(TSGetMaxTime(ts, &end));
  PetscCall(TSGetTimeStep(ts, &dt));
  if (has_fixed_steps(ts) && rejected > 0 && dt < run->nominal_dt && time < end)
    PetscCall(TSSetTimeStep(ts, std::min({2 * dt, run->nominal_dt, end - time})));
  return 0;
}

// The monitor could not: a step clears the reason.
void stop_if_asked(const Run& run, TS ts) {
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  if (!run.checkpoints.stop || !run.checkpoints.stop()) return;
  check(TSGetConvergedReason(ts, &reason));
  if (reason == TS_CONVERGED_ITERATING) check(TSSetConvergedReason(ts, TS_CONVERGED_USER));
}

void accept(Run& run, TS ts) {
  Vec U = nullptr, V = nullptr, A = nullptr;
  PetscReal time = 0, end = 0;
  check(TSGetTime(ts, &time));
  check(TSGetMaxTime(ts, &end));
  generalized_alpha_state(ts, &U, &V, &A);
  const bool is_observed = has_due_state(run) || time >= end;
  run.problem.system.accept({time, *ReadView(U), *ReadView(V), *ReadView(A)}, is_observed);
}

// An impulse is no part of the acceleration with which the next step begins.
void leave_out_impulse(const System& system, TS ts) {
  if (system.had_impulse())
    generalized_alpha_set_acceleration(ts, StepAcceleration::at_start);
  else if (system.had_impulse_before())
    generalized_alpha_set_acceleration(ts, StepAcceleration::mean);
}

// Rotation vectors of free bodies begin at zero in every step.
void rebase(System& system, TS ts) {
  Vec U = nullptr, V = nullptr, A = nullptr;
  generalized_alpha_state(ts, &U, &V, &A);
  Eigen::VectorXd positions = *ReadView(U);
  if (!system.rebase(positions)) return;
  assign(U, positions);
  generalized_alpha_set_state(ts, U, V, A);
}

PetscErrorCode post_step(TS ts) {
  Run* run = nullptr;
  PetscCall(TSGetApplicationContext(ts, &run));
  PetscCall(guard(run->problem.pending, [&] {
    follow_time_errors(*run, ts);
    observe_since_last_step(*run, ts);
    accept(*run, ts);
    leave_out_impulse(run->problem.system, ts);
    rebase(run->problem.system, ts);
    if (run->settings.relax) relax(*run, ts);
    require_long_steps(*run, ts);
    stop_if_asked(*run, ts);
  }));
  return recover_dt(ts);
}

// Materials relax step by step, and forces of impacts are found so.
PetscErrorCode pre_stage(TS ts, PetscReal) {
  Run* run = nullptr;
  PetscReal dt = 0, alpha_f = 0;
  PetscCall(TSGetApplicationContext(ts, &run));
  PetscCall(TSGetTimeStep(ts, &dt));
  PetscCall(TSAlpha2GetParams(ts, nullptr, &alpha_f, nullptr, nullptr));
  return guard(run->problem.pending, [&] { run->problem.system.begin_step(dt, alpha_f); });
}

PetscErrorCode check_stage(TS ts, bool* changed) {
  Run* run = nullptr;
  PetscCall(TSGetApplicationContext(ts, &run));
  return guard(run->problem.pending, [&] { *changed = run->problem.system.change_closed(); });
}

PetscErrorCode post_stage(TS ts, PetscReal, PetscInt, Vec*) {
  Run* run = nullptr;
  SNES snes = nullptr;
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscReal alpha_m = 0, gamma = 0;
  PetscCall(TSGetApplicationContext(ts, &run));
  PetscCall(TSAlpha2GetParams(ts, &alpha_m, nullptr, &gamma, nullptr));
  PetscCall(TSGetSNES(ts, &snes));
  PetscCall(SNESGetConvergedReason(snes, &reason));
  return guard(run->problem.pending, [&] { run->problem.system.end_step(reason > 0, gamma / alpha_m); });
}

void follow_stages(const System& system, TS ts) {
  if (!system.any_augmented() && !system.relaxes_in_time()) return;
  check(TSSetPreStage(ts, pre_stage));
  check(TSSetPostStage(ts, post_stage));
  if (!system.any_augmented()) return;
  generalized_alpha_set_check(ts, [ts](bool* changed) { return check_stage(ts, changed); });
}

void set_time(TS ts, const Run& run) {
  check(TSSetTimeStep(ts, run.settings.dt > 0 ? run.settings.dt : first_step(run)));
  check(TSSetMaxTime(ts, run.settings.end_time));
  check(TSSetMaxSteps(ts, std::numeric_limits<PetscInt>::max()));
  check(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  check(TSSetMaxSNESFailures(ts, std::numeric_limits<PetscInt>::max()));
  check(TSSetErrorIfStepFails(ts, PETSC_FALSE));
}

}  // namespace

bool is_out_of_steps(TS ts) {
  PetscReal time = 0, end = 0;
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetConvergedReason(ts, &reason));
  check(TSGetTime(ts, &time));
  check(TSGetMaxTime(ts, &end));
  return reason == TS_CONVERGED_ITS && time < end;
}

UniqueTS make_ts(Run& run, Vec U, Vec V, UniqueMat& J) {
  UniqueTS ts;
  check(TSCreate(PETSC_COMM_SELF, ts.out()));
  register_generalized_alpha();
  check(TSSetType(ts, "generalized_alpha"));
  check(TSAlpha2SetRadius(ts, run.settings.rho_inf));
  TSAdapt adapt = nullptr;
  check(TSGetAdapt(ts, &adapt));
  check(TSAdaptSetType(adapt, TSADAPTNONE));
  attach(run.problem, ts, J);
  set_time(ts, run);
  check(TSSetApplicationContext(ts, &run));
  check(TSSetPostStep(ts, post_step));
  check(TSMonitorSet(ts, monitor, &run, nullptr));
  check(TS2SetSolution(ts, U, V));
  control_steps(run, ts);
  check(TSSetFromOptions(ts));
  if (!run.settings.relax) set_force_tolerance(run, ts);
  if (!run.settings.relax) run.time_error = new_time_errors(run.problem.system);
  measure_stress(run, ts);
  if (!run.settings.relax) follow_stages(run.problem.system, ts);
  check(TSGetTimeStep(ts, &run.nominal_dt));
  require(run.nominal_dt > 0, "time step dt = ", run.nominal_dt, " s must be positive");
  return ts;
}

}  // namespace elastogear::dynamics
