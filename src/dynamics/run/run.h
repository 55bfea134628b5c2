#pragma once
// One time integration in progress. Private to module dynamics.

#include <chrono>
#include <memory>

#include "dynamics/errors/time_error.h"
#include "dynamics/integrator/problem.h"
#include "dynamics/integrator/sanity.h"
#include "dynamics/run/snapshot.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::dynamics {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A checkpoint is of another system, or of another version of the program.
struct UnfitState : Error {
  using Error::Error;
};

/// What the control of steps measures errors against.
struct StepControl {
  Eigen::VectorXd per_length = {};  // changes of the coordinates that move a body's surface by up to 1 m
  double size = 0;                  // m, largest distance from the centre of a joint
  double displacement = 0;          // m, largest elastic amplitude of the last state
  Eigen::VectorXd stiffness = {};   // J/m^2, of each body: twice the elastic energy of the softest coordinate
                                    // that moves the surface by up to 1 m; 0: has none, or the full basis
  Eigen::VectorXd stress = {};      // J^(1/2), of each body: tolerated energy norm of a local error
  double longest_step = 0;          // s, that PETSc's options allow (-ts_adapt_dt_max)
  std::vector<Eigen::Matrix3Xd> corners =
      {};  // m, of boxes around the surfaces of the bodies, in their frames
};

struct Run {
  Run(System& system, const TimeSettings& s, const Observer& o, const Progress& p, const Checkpoints& c)
      : problem(system), settings(s), observer(o), progress(p), checkpoints(c), sanity(system) {}

  Problem problem;
  const TimeSettings& settings;
  const Observer& observer;
  const Progress& progress;
  const Checkpoints& checkpoints;
  EnergyLedger ledger;
  Sanity sanity;
  std::shared_ptr<const model::Snapshot> last;  // null: none yet
  bool last_observed = true;                    // nothing to observe yet
  double nominal_dt = 0;                        // s, at the start
  RunSummary summary;                           // its counts: of the time before this run was continued
  int n_outputs = 1;                            // of those output_dt apart; the first is the start
  bool step_is_due = false;                     // an output falls on the end of the last step
  StepControl control;
  std::vector<TimeError> time_error = {};  // of each body, of size 0 without a modal basis; empty: relaxes
  bool touches = false;                    // some bodies touch at the end of the last step
  double energy = 0;                       // J, kinetic and elastic then
  double kinetic_energy = 0;               // J, after the last step of a relaxing run
  double unbalanced = -1, least_unbalanced = 1;  // shares of its forces without velocities: last and least
  int short_steps = 0;                  // successive ones that Newton's failures keep far below nominal_dt
  double longest_short = 0;             // s, of those
  int entered_step = -1;                // the last one in ledger and summary
  bool interrupted = false;             // a step was given up because the run was asked to stop
  std::vector<double> step_state = {};  // a checkpoint of the last step, where the steps take long; or empty
  Clock::time_point start = Clock::now(), kept = start, step_start = start;
};

/// The integrator of a run that begins at U and V, with all that it calls at steps. J is created; U, V, J and
/// the run must outlive it.
UniqueTS make_ts(Run& run, Vec U, Vec V, UniqueMat& J);
/// Did it stop at the largest number of steps, before the end time?
bool is_out_of_steps(TS ts);

/// Message where a static equilibrium is looked for and materials relax with time.
inline constexpr const char* kNoHistory =
    "static equilibria have no history: viscoelastic materials need their instantaneous or their long-term "
    "moduli there (option moduli)";

/// Throws Error when surfaces of a pair lie inside each other at the start.
void require_bodies_apart(System& system);
RunSummary new_summary(const System& system);
/// Enters the peaks of a snapshot into the summary.
void update(RunSummary& summary, const model::Snapshot& snapshot);

/// Hands the last snapshot to the observer.
void observe(Run& run);
/// Observes the output times before the end of the last step; coordinates must not be re-based yet.
void observe_since_last_step(Run& run, TS ts);
/// May the end of the last step be observed? After observe_since_last_step.
bool has_due_state(const Run& run);
/// The next time of output after `time`, at the end of a step, s; infinite: there is none.
double next_output(const Run& run, double time);
/// Enters the state after a step into ledger and summary, and observes it when it is due.
void enter_step(Run& run, TS ts, int step, double time);
void report_step(const Run& run, TS ts, int step);

/// One for each body: of the elastic coordinates of modal bases.
std::vector<TimeError> new_time_errors(const System& system);
/// After a step: lets the errors that steps leave in elastic coordinates follow it.
void follow_time_errors(Run& run, TS ts);

/// Control of the steps, where they are chosen.
void control_steps(Run& run, TS ts);
/// Lets the control of steps see errors of the elastic coordinates by the stresses that they mean
/// (docs/theory, Eq. (8.9a)), where steps are chosen by a share of what there is.
void measure_stress(Run& run, TS ts);
/// Tells the system how closely forces are balanced where steps are chosen; to be called once options are
/// read.
void set_force_tolerance(Run& run, TS ts);
/// The first step, s, where there is no dt.
double first_step(const Run& run);
/// Takes the elastic displacements and energies of the last state for the tolerances of the next steps.
void follow_displacement(Run& run);
/// Sets tolerance and limits of the next steps, where they are chosen.
void limit_steps(Run& run, TS ts);

/// After a step of a relaxing run: rest at each peak of the kinetic energy; the end when nothing moves any
/// more.
void relax(Run& run, TS ts);

/// Everything on which the rest of the run depends, between two steps. Played back into a TS that is set up.
void serialize_state(Run& run, TS ts, Archive& archive);

std::vector<double> state_now(Run& run, TS ts);
/// Hands the present state to the keeper of checkpoints, if there is one.
void keep_state(Run& run, TS ts);

}  // namespace elastogear::dynamics
