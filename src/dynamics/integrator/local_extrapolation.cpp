// Local extrapolation: the error of a step, taken out of slow coordinates (docs/theory.md, section 8.3).
#include "dynamics/integrator/generalized_alpha_method.h"
#include "elastogear/base/petsc.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace generalized_alpha {
namespace {

// The last term of sigma in Eq. (8.9b), which damps vibrations.
constexpr PetscReal kDamping = 0.2;
// Errors below this share of the tolerance are hardly taken out, Eq. (8.9c).
constexpr PetscReal kSmall = 0.05;

PetscReal lag(const Parameters& p) { return p.alpha_m - p.alpha_f; }

// C_U + C_V of Eq. (8.9a).
PetscReal constant_of_both(const Parameters& p) {
  return position_constant(p) + PetscReal(1) / 12 - lag(p) * (1 - 2 * p.alpha_f) / 2;
}

// change := that of the slope in a step like the one from start to end, which has `slope`.
PetscErrorCode find_change(TS ts, Vec slope, Vec change) {
  const SlopeHistory& last = method(ts).last;
  PetscCall(VecCopy(slope, change));
  PetscCall(VecAXPY(change, -1, last.slope));
  return VecScale(change, 2 * ts->time_step / (ts->time_step + last.step));
}

// Share of an error that is taken out: little of one that is small beside the tolerance. Eq. (8.9c).
PetscErrorCode share_of(TS ts, Vec error, PetscReal* share) {
  const Method& m = method(ts);
  PetscReal size = 0, absolute = 0, relative = 0;
  const Vec y = m.at_stage.U;
  PetscCall(VecWAXPY(y, 1, error, m.current.U));
  PetscCall(TSErrorWeightedNorm(ts, m.current.U, y, ts->adapt->wnormtype, &size, &absolute, &relative));
  *share = size * size / (size * size + kSmall * kSmall);
  return 0;
}

}  // namespace

bool extrapolates(const Method& m) { return m.extrapolated && lag(m.parameters) > 0; }

PetscErrorCode extrapolated_error(TS ts, Vec error) {
  Method& m = method(ts);
  const PetscReal dt = ts->time_step, C = constant_of_both(m.parameters);
  if (!extrapolates(m) || m.last.step == 0) return 0;
  const Vec slope = m.at_stage.V, change = m.at_stage.A;
  PetscCall(find_slope(ts, slope));
  PetscCall(find_change(ts, slope, change));
  PetscCall(VecAXPBY(change, -1, C * dt * dt * dt, error));
  PetscCall(VecPointwiseMult(change, change, m.extrapolated));
  return VecAXPY(error, 1, change);
}

PetscErrorCode extrapolate(TS ts) {
  Method& m = method(ts);
  if (!extrapolates(m) || m.last.step == 0) return 0;
  const PetscReal C = constant_of_both(m.parameters), dt = ts->time_step, third = dt * dt * dt,
                  sigma = PetscReal(0.5) + lag(m.parameters) + kDamping;
  const Vec error = m.at_stage.V, change = m.at_stage.A;
  PetscReal share = 0;
  PetscCall(find_slope(ts, error));
  PetscCall(find_change(ts, error, change));
  PetscCall(VecPointwiseMult(error, error, m.extrapolated));
  PetscCall(VecPointwiseMult(change, change, m.extrapolated));
  PetscCall(VecAXPBY(error, C * sigma * third, C * third, change));
  PetscCall(share_of(ts, error, &share));
  PetscCall(VecAXPY(m.current.U, -share, error));
  PetscCall(VecCopy(m.current.U, ts->vec_sol));
  return PetscObjectStateGet((PetscObject)ts->vec_sol, &m.solution_state);
}

}  // namespace generalized_alpha

void generalized_alpha_extrapolate(TS ts, Vec entries) {
  generalized_alpha::Method& m = generalized_alpha::ready_method(ts);
  check(VecDestroy(&m.extrapolated));
  check(VecDuplicate(entries, &m.extrapolated));
  check(VecCopy(entries, m.extrapolated));
}

StepHistory generalized_alpha_history(TS ts) {
  generalized_alpha::Method& m = generalized_alpha::ready_method(ts);
  return {m.last.slope, &m.last.step};
}

}  // namespace elastogear::dynamics
