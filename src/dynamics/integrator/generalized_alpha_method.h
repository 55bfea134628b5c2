#pragma once
// The arithmetic of one generalised-alpha step and its nonlinear solves (docs/theory, section 8). Private
// to module dynamics.

#include <petscts.h>

#include <functional>

namespace elastogear::dynamics::generalized_alpha {

struct Parameters {
  PetscReal alpha_m, alpha_f, gamma, beta;
};

/// Optimal parameters for a spectral radius rho_inf in 0..1, Eqs. (8.4) and (8.5).
Parameters parameters_for(PetscReal rho_inf);

/// C_U of Eq. (8.9).
inline PetscReal position_constant(const Parameters& p) {
  return p.beta - (p.alpha_m - p.alpha_f) / 2 - PetscReal(1) / 6;
}

enum class Predictor { none, constant_acceleration, zero_acceleration };

struct Motion {
  Vec U, V, A;
};

/// The stage at which F is evaluated: base + c * Delta at time t, Eq. (8.6).
struct Stage {
  PetscReal t, c_U, c_V, c_A;
  PetscReal shift_V, shift_A;  ///< dV/dU and dA/dU for the Jacobian callback
  PetscReal scale;             ///< of F, so that its derivative in Delta is the callback's Jacobian
};

/// What a step takes from the one before, besides U and V.
struct SlopeHistory {
  Vec A;           ///< at its end, lagging by its lag
  Vec slope;       ///< of A from its start to its end
  PetscReal step;  ///< s, 0: A has been solved for since
};

struct Method {
  Parameters parameters;
  Predictor predictor;
  PetscReal velocity_rtol, velocity_atol;
  Vec velocity_vatol;  ///< in place of velocity_atol, or null

  Motion current;  ///< accepted state; U and V are copies of the solution, to notice changes made outside
  bool acceleration_known;
  PetscObjectState solution_state;  ///< of the solution when current was recorded; -1 after set_state
  Motion start, end;                ///< of the last step, as integrated
  PetscReal step_time, step_size;

  Stage stage;
  Motion base, at_stage;
  Vec Delta, residual;
  SlopeHistory last;
  std::function<PetscErrorCode(bool*)> check;  ///< has F changed with the solution? May be empty
  /// Another norm of the local error of U over its tolerance. May be empty.
  std::function<PetscErrorCode(Vec error, PetscReal* norm)> measure;
};

Method& method(TS ts);
/// The same once TS is set up. Throws Error for another TS type.
Method& ready_method(TS ts);

/// What a step reads of TS.
struct StepContext {
  Vec U, V;  ///< solution, as of the last accepted step
  SNES snes;
  PetscReal time, step, time_before;
};

StepContext context_of(TS ts);
/// Adds to TSGetSNESIterations and TSGetKSPIterations.
PetscErrorCode count_iterations(TS ts, PetscInt newton, PetscInt linear);

PetscErrorCode create_vectors(TS ts);
PetscErrorCode destroy_vectors(Method& m);
PetscErrorCode copy(const Motion& from, const Motion& to);

/// end := predictor, then the solution of F = 0 at the stage. The outcome is the reason of the SNES.
/// Eq. (8.1).
PetscErrorCode solve_step(TS ts);

/// current := (U, V, A) of the solution with F(t, U, V, A) = 0, Eq. (8.7). The outcome is the reason of the
/// SNES.
PetscErrorCode solve_acceleration(TS ts);

/// A of the method belongs to a time that lags t by (alpha_m - alpha_f) dt: start.A := that of the step
/// before, moved to the lag of a step of the present size, Eq. (8.8), never past A at the start of the one
/// before.
PetscErrorCode move_lag(TS ts);
/// slope := that of A from start to end, over the time step.
PetscErrorCode find_slope(TS ts, Vec slope);
/// Keeps the slope of a step that is taken for the next one.
PetscErrorCode remember_slope(TS ts);

/// U at a time between the ends of the last step, Eq. (8.10), and V and A, Eq. (8.17).
PetscErrorCode interpolate(TS ts, PetscReal t, Vec U);
PetscErrorCode interpolate_velocity(TS ts, PetscReal t, Vec V);
PetscErrorCode interpolate_acceleration(TS ts, PetscReal t, Vec A);
/// x := the end of a step from the start of the last one to t. Not solved: Newton's method does not converge.
PetscErrorCode solve_between(TS ts, PetscReal t, const Motion& x, bool* solved);

/// The callbacks of the SNES.
PetscErrorCode stage_function(SNES, Vec Delta, Vec F, TS ts);
PetscErrorCode stage_jacobian(SNES, Vec Delta, Mat J, Mat P, TS ts);

}  // namespace elastogear::dynamics::generalized_alpha
