#include <algorithm>

#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace {

constexpr double kClosed = 1e-6;  // of the depth, that closed gaps may be open: bodies are nearly at rest

double kinetic_energy(const System& system, const State& x) {
  double energy = 0;
  for (std::size_t b = 0; b < system.bodies().size(); ++b)
    energy += body::kinetic_energy(system.bodies()[b].eq, system.motion(b, x));
  return energy;
}

// Goes on with the forces found where their gaps are not yet closed.
bool augmented(Run& run) {
  System& system = run.problem.system;
  if (!system.any_augmented() || system.unclosed() <= kClosed) return false;
  system.augment();
  return true;
}

}  // namespace

void relax(Run& run, TS ts) {
  Vec U = nullptr, V = nullptr, A = nullptr;
  PetscReal time = 0;
  generalized_alpha_state(ts, &U, &V, &A);
  check(TSGetTime(ts, &time));
  const Eigen::VectorXd u = *ReadView(U), v = *ReadView(V), zero = Eigen::VectorXd::Zero(u.size());
  const double energy = kinetic_energy(run.problem.system, {time, u, v, zero});
  run.unbalanced = imbalance(run.problem.system.residual({time, u, zero, zero}));
  run.least_unbalanced = std::min(run.least_unbalanced, run.unbalanced);
  const bool in_balance = run.unbalanced <= run.settings.rest_tolerance,
             rests = in_balance && !augmented(run);
  const bool past_peak = energy < run.kinetic_energy;
  run.kinetic_energy = past_peak ? 0 : energy;
  if (in_balance || past_peak) check(VecZeroEntries(V));  // A follows from F = 0
  if (!rests) return;
  run.summary.at_rest = true;
  check(TSSetConvergedReason(ts, TS_CONVERGED_EVENT));
}

}  // namespace elastogear::dynamics
