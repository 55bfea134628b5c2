#pragma once
// Generalised-alpha for F(t, U, V, A) = 0 as a PETSc TS type (docs/theory, section 8).
//
// The problem is given by TSSetI2Function, TSSetI2Jacobian and TS2SetSolution; everything else is PETSc's
// usual TS. Options, beside -ts_*, -ts_adapt_*, -snes_*, -ksp_*:
//   -ts_alpha_radius rho_inf              spectral radius at infinite frequency, 0..1 (default 1: no
//   dissipation) -ts_alpha_alpha_m, _alpha_f, _gamma, _beta   the four parameters one by one. alpha_m and
//   alpha_f weight the
//                                         *new* state, as in PETSc: one minus those of Chung and Hulbert
//   -ts_alpha_predictor none | constant_acceleration | zero_acceleration
//   -ts_alpha_velocity_rtol, _velocity_atol   error control of V (default 0, 0: only U is controlled)
// The SNES unknown is the change of U against the predictor, not U itself: small displacements are resolved
// on top of large ones, and -snes_stol is relative to that change. A linear problem (TS_LINEAR, SNESKSPONLY)
// is solved exactly; a nonlinear one under SNESKSPONLY ends in PETSC_ERR_NOT_CONVERGED. For the acceleration
// at the start the Jacobian callback is called with shift_V = 0 and a shift_A so large that the Jacobian is
// shift_A dF/dA to roundoff; dF/dA must be regular.

#include <petscts.h>

#include <functional>

namespace elastogear::dynamics {

/// Registers the TS type "generalized_alpha" beside PETSc's "alpha2", which up to 3.21 starts with twice the
/// true acceleration. May be called more than once. TSAlpha2SetRadius and its kin work on both.
void register_generalized_alpha();

/// Borrowed U, V, A at the accepted step. They may be changed in place if set_state follows. Where A is not
/// known (before the first step, after a restart or a change of U or V) it is solved from F(t, U, V, A) = 0.
/// Any pointer may be null. Throws Error for another TS type or when that solve fails.
void generalized_alpha_state(TS ts, Vec* U, Vec* V, Vec* A);

/// Replaces the accepted state; the next step continues from exactly these values, so a run resumed with the
/// stored U, V, A, history, time, time step and step number equals the uninterrupted one bit for bit. Also
/// the way to re-base coordinates in a TSPostStep callback. Needs TS2SetSolution, and TSSolve with the same U
/// or nullptr.
void generalized_alpha_set_state(TS ts, Vec U, Vec V, Vec A);

struct MotionVectors {
  Vec U, V, A;
};
/// U by Eq. (8.10), V and A by Eq. (8.17) between the ends of the last step, as integrated.
void generalized_alpha_interpolate(TS ts, double t, const MotionVectors& x);

/// The same by a step from the start of the last one to t, at whose stage F = 0 (docs/theory,
/// section 8.2); the run goes on from the end of the last step all the same. False: Newton's method does not
/// converge, and x is none.
bool generalized_alpha_solve_between(TS ts, double t, const MotionVectors& x);

/// The last step as integrated: the motion at both ends, where A at the start is moved by Eq. (8.8), its
/// start and size (s), and the weights of the new state in its stage. Borrowed until the next step.
struct LastStep {
  MotionVectors start, end;
  double time, size;
  double alpha_m, alpha_f;
};
LastStep generalized_alpha_last_step(TS ts);

/// Absolute tolerances of U and V per entry: scale times these. velocity 0: V is not controlled.
void generalized_alpha_set_tolerances(TS ts, Vec scale, double position, double velocity);

/// `measure` gives a norm of the local error of U over what is tolerated of it. Error control takes the
/// larger one of it and of the weighted norm with the tolerances above.
void generalized_alpha_set_measure(TS ts,
                                   const std::function<PetscErrorCode(Vec error, PetscReal* norm)>& measure);

/// What a step takes from the one before, besides U, V and A (docs/theory, Eq. (8.8)).
/// Borrowed: a run that goes on gets both back in place, after set_state.
struct StepHistory {
  Vec slope;     ///< of A in the last step
  double* step;  ///< its size, s; 0: A has been solved for since
};
StepHistory generalized_alpha_history(TS ts);

/// `check` is called with every solution of F = 0 at the stage of a step and tells whether F has become
/// another function, whose zero is to be found from there.
void generalized_alpha_set_check(TS ts, const std::function<PetscErrorCode(bool* changed)>& check);

/// After an impulse in the last step, which is no part of the acceleration that the next one begins with:
/// that becomes the one at the start of the last step, or the mean one of it.
enum class StepAcceleration { at_start, mean };
void generalized_alpha_set_acceleration(TS ts, StepAcceleration acceleration);

/// After a discontinuity of F: the next step starts from the acceleration that solves F(t, U, V, A) = 0.
/// Changing U or V without set_state does the same.
void generalized_alpha_restart(TS ts);

}  // namespace elastogear::dynamics
