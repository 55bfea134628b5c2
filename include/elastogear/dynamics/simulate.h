#pragma once
// Time integration of a system by PETSc's TS with our generalised-alpha type and the exact low-rank solver.
// -ts_*, -snes_*, -ksp_* of the options database win over the settings.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "elastogear/base/progress.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::dynamics {

/// The state of a run after a step.
struct StepInfo {
  int step = 0;
  double time = 0, dt = 0;    ///< s, reached; of the next step
  int newton_iterations = 0;  ///< so far
  int contacts = 0;
  double penetration = 0;  ///< m, largest
  double unbalanced = -1;  ///< share of the forces, without velocities; of a relaxing run, else negative
  double balance = 0;      ///< J, of the energy ledger
};

struct TimeSettings {
  double dt = 0;         ///< s, of the first step, and of all unless they are chosen; 0: they are chosen
  double end_time = 0;   ///< s
  double rho_inf = 1;    ///< -, 0..1, spectral radius at infinite frequency; 1: no numerical dissipation
  int output_every = 1;  ///< observe every n-th step, and the first and last state
  /// Not the motion is wanted but where it comes to rest: velocities are set to zero at each peak of the
  /// kinetic energy, and the run ends when without velocities the residual of every block is below
  /// rest_tolerance times the sum of the norms of its forces. Loads should be constant by then.
  bool relax = false;
  double rest_tolerance = 1e-6;
  /// s; > 0: observe at its multiples in place of every n-th step. Steps that are chosen end there; between
  /// the ends of others states are those of a step that ends there (docs/theory, section 8.2).
  double output_dt = 0;
  /// s, ascending; observe at these times and at no others but the start and the end, in the same way.
  std::vector<double> output_times = {};
  /// Steps are chosen (PETSc's basic adaptivity, -ts_adapt_*) where there is no dt or step_tolerance, m, is
  /// positive: so that the local error moves no surface node farther than step_tolerance or, where that is 0,
  /// so that it is at most the share step_error, -, of the elastic displacements and, in the energy norm, of
  /// the elastic state of each body, which bounds the stresses. The step in which bodies first touch
  /// is short, and surfaces of a pair go by less than the contact depth. velocity_tolerance, m/s, > 0:
  /// velocities too. docs/theory, section 8.3.
  double step_error = 1e-5, step_tolerance = 0, velocity_tolerance = 0;
  std::function<void(const StepInfo&)> monitor = {};  ///< after every step
};

struct PairSummary {
  std::string name;
  double peak_force = 0;   ///< N, largest norm of the total force
  double peak_time = 0;    ///< s
  double penetration = 0;  ///< m, largest
  int patch_nodes = 0;     ///< slave nodes of the busiest area of contact at that time, of both passes
};

struct RunSummary {
  int steps = 0, rejected_steps = 0, newton_iterations = 0;
  int most_contacts = 0;  ///< active at one time, over all pairs
  std::vector<PairSummary> pair;
  double initial_energy = 0;     ///< J, stored at the start
  double work = 0;               ///< J, of the loads up to the last state
  double largest_imbalance = 0;  ///< J, largest |balance| of the energy ledger
  double turned_over = 0;        ///< J, stored at the start and turned over by loads and motions
  double unbalanced = 0;      ///< largest share of the forces that an equilibrium leaves where contact jumps
  double wall_time = 0;       ///< s
  bool complete = false;      ///< reached the end time, or rest; else stopped before
  bool out_of_steps = false;  ///< stopped by -ts_max_steps
  double time = 0;            ///< s, reached
  bool at_rest = false;       ///< of a relaxing run: came to rest before its end time
  double step_tolerance = 0;  ///< m, of the local error of the last step; 0: steps were not chosen
};

using Observer = std::function<void(const model::Snapshot&)>;

/// How a run is made to survive its end by force.
struct Checkpoints {
  double every = 60;  ///< s of wall time between two; 0: after each step
  /// Takes a state from which the run can go on, also before an Error; empty: none are made.
  std::function<void(const std::vector<double>& state)> keep = {};
  /// Asked after each step; true ends the run with a last checkpoint. Asked too at each evaluation, product
  /// and solve within a step that has taken `patience` (s of wall time): true gives that step up.
  std::function<bool()> stop = {};
  double patience = 1;
  /// Such a state of an equal system, to go on from instead of the initial one; empty: none.
  std::vector<double> state = {};
};

/// A run that its owner advances step by step.
class Simulation {
 public:
  /// The run that simulate() would make of the same arguments, with its errors, before its first state. The
  /// system must outlive it.
  Simulation(System& system, TimeSettings settings, Observer observer = {}, Progress progress = {},
             Checkpoints checkpoints = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  /// Enters the first state when called for the first time, then takes one step with each call. False when
  /// there was no step to take any more, or when `stop` of the checkpoints gave it up. After an Error the run
  /// has ended.
  bool advance();
  bool ended() const;
  /// The last state that was reached; null before the first one. It stays as it is when the run goes on.
  std::shared_ptr<const model::Snapshot> state() const;
  /// Ends the run: the last state is observed if it was not, and counts and times are complete.
  RunSummary finish();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Runs from the system's initial state to the end time. Newton has converged when in every block (joint and
/// elastic coordinates of each body) the residual is below -snes_rtol (default 1e-8) times the sum of the
/// norms of the forces it balances; a step that cannot be solved is cut by TSAdapt, and dt recovers
/// afterwards. Throws Error for settings that make no sense, and when a step cannot be cut further; the last
/// good state has then been observed. Continued from a checkpoint with equal settings, all that is observed
/// from there on equals the uninterrupted run to the bit.
RunSummary simulate(System& system, const TimeSettings& settings, const Observer& observer,
                    const Progress& progress = {}, const Checkpoints& checkpoints = {});

}  // namespace elastogear::dynamics
