#pragma once
// Time integration of a system by PETSc's TS with our generalised-alpha type and the exact low-rank solver.
// -ts_*, -snes_*, -ksp_* of the options database win over the settings.

#include <functional>
#include <string>
#include <vector>

#include "elastogear/base/progress.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::dynamics {

struct TimeSettings {
  double dt = 0;         ///< s
  double end_time = 0;   ///< s
  double rho_inf = 1;    ///< -, 0..1, spectral radius at infinite frequency; 1: no numerical dissipation
  int output_every = 1;  ///< observe every n-th step, and the first and last state
};

struct PairSummary {
  std::string name;
  double peak_force = 0;   ///< N, largest norm of the total force
  double peak_time = 0;    ///< s
  double penetration = 0;  ///< m, largest
};

struct RunSummary {
  int steps = 0, rejected_steps = 0, newton_iterations = 0;
  int most_contacts = 0;  ///< active at one time, over all pairs
  std::vector<PairSummary> pair;
  double initial_energy = 0;     ///< J, stored at the start
  double largest_imbalance = 0;  ///< J, largest |balance| of the energy ledger
  double wall_time = 0;          ///< s
};

using Observer = std::function<void(const model::Snapshot&)>;

/// Runs from the system's initial state to the end time. Newton has converged when in every block (joint and
/// elastic coordinates of each body) the residual is below -snes_rtol (default 1e-8) times the sum of the
/// norms of the forces it balances; a step that cannot be solved is cut by TSAdapt, and dt recovers
/// afterwards. Throws Error for settings that make no sense, and when a step cannot be cut further.
RunSummary simulate(System& system, const TimeSettings& settings, const Observer& observer,
                    const Progress& progress = {});

}  // namespace elastogear::dynamics
