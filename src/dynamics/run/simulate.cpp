#include "elastogear/dynamics/simulate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/initial_overlap.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace {

void validate_output(const TimeSettings& settings) {
  const std::vector<double>& times = settings.output_times;
  require(settings.output_dt >= 0 && std::isfinite(settings.output_dt), "output_dt = ", settings.output_dt,
          " s must not be negative");
  require(settings.output_every >= 1, "output_every = ", settings.output_every, " must be at least 1");
  require(times.empty() || settings.output_dt == 0, "output_dt and output_times exclude each other");
  for (std::size_t i = 0; i < times.size(); ++i) {
    require(times[i] >= 0 && times[i] <= settings.end_time, "output_times: ", times[i],
            " s is outside the run, 0 .. ", settings.end_time, " s");
    require(i == 0 || times[i] > times[i - 1], "output_times: ", times[i], " s does not come after ",
            times[i - (i > 0)], " s");
  }
}

void validate(const TimeSettings& settings) {
  require(std::isfinite(settings.dt) && settings.dt >= 0, "time step dt = ", settings.dt,
          " s must be positive");
  require(settings.dt > 0 || !settings.relax,
          "time step dt is missing: settling has no error by which steps could be chosen; a tenth of the "
          "slowest period serves");
  require(std::isfinite(settings.end_time) && settings.end_time > 0, "end time ", settings.end_time,
          " s must be positive");
  require(settings.rho_inf >= 0 && settings.rho_inf <= 1, "rho_inf = ", settings.rho_inf,
          " must lie in 0..1");
  require(settings.rest_tolerance > 0, "rest tolerance ", settings.rest_tolerance, " must be positive");
  require(settings.step_tolerance >= 0 && settings.velocity_tolerance >= 0, "step tolerance ",
          settings.step_tolerance, " m and velocity tolerance ", settings.velocity_tolerance,
          " m/s must not be negative");
  require(settings.step_error > 0 && settings.step_error < 1, "step error ", settings.step_error,
          " must lie between 0 and 1");
  validate_output(settings);
}

void validate(const Checkpoints& checkpoints) {
  require(checkpoints.every >= 0, "time between two checkpoints ", checkpoints.every,
          " s must not be negative");
  require(checkpoints.patience >= 0, "time that a step may still take ", checkpoints.patience,
          " s must not be negative");
}

void require_tables_cover(const System& system, double end_time) {
  for (const System::Body& body : system.bodies())
    for (const Axis& axis : body.axis) require_covers(axis, end_time, "body '" + body.name + "': ");
  system.marker_forces().require_tables_cover(end_time);
}

// Has the method no numerical damping, rho_inf = 1 in docs/theory, Eq. (8.5)?
bool is_undamped(TS ts) {
  PetscReal alpha_f = 0;
  check(TSAlpha2GetParams(ts, nullptr, &alpha_f, nullptr, nullptr));
  return alpha_f <= 0.5;
}

// Friction that follows the speed is stiff where it turns over.
std::string friction_advice(const System& system) {
  for (std::size_t p = 0; p < system.pairs().size(); ++p)
    if (const contact::FrictionSettings& friction = system.contact_settings(p).friction;
        friction.mu > 0 && friction.law == contact::FrictionLaw::regularised)
      return ", -contact_friction_law stick, a larger -contact_friction_speed";
  return "";
}

void require_solved(const Run& run, TS ts) {
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  PetscReal time = 0, dt = 0;
  check(TSGetConvergedReason(ts, &reason));
  check(TSGetTime(ts, &time));
  check(TSGetTimeStep(ts, &dt));
  const std::string& trouble = run.problem.trouble;
  require(reason > 0, "the step at t = ", time, " s cannot be solved, not even with dt cut to ", dt,
          " s: ", trouble.empty() ? "Newton's method does not converge" : trouble, " (",
          TSConvergedReasons[reason], "). Try a smaller time step (-ts_dt)",
          friction_advice(run.problem.system),
          is_undamped(ts) ? ", numerical damping (-ts_alpha_radius 0.8)" : "",
          run.summary.pair.empty() ? "" : ", a smaller -contact_stiffness or a larger -contact_depth");
}

// The first step must not pass the end. One that ends there is left as it is: a run that goes on has chosen
// it.
void end_on_time(TS ts) {
  PetscReal time = 0, end = 0, dt = 0;
  TSExactFinalTimeOption option = TS_EXACTFINALTIME_UNSPECIFIED;
  check(TSGetTime(ts, &time));
  check(TSGetMaxTime(ts, &end));
  check(TSGetTimeStep(ts, &dt));
  check(TSGetExactFinalTime(ts, &option));
  const double left = end - time;
  const bool reaches = dt >= left || PetscIsCloseAtTol(dt, left, 10 * PETSC_MACHINE_EPSILON, 0);
  if (option == TS_EXACTFINALTIME_MATCHSTEP && reaches && time + dt != end) check(TSSetTimeStep(ts, left));
}

TSConvergedReason reason_of_extent(TS ts) {
  PetscInt step = 0, most = 0;
  PetscReal time = 0, end = 0;
  check(TSGetStepNumber(ts, &step));
  check(TSGetMaxSteps(ts, &most));
  check(TSGetTime(ts, &time));
  check(TSGetMaxTime(ts, &end));
  if (step >= most) return TS_CONVERGED_ITS;
  return time >= end ? TS_CONVERGED_TIME : TS_CONVERGED_ITERATING;
}

void enter_state(Run& run, TS ts) {
  PetscInt step = 0;
  PetscReal time = 0;
  Vec U = nullptr;
  check(TSGetStepNumber(ts, &step));
  check(TSGetTime(ts, &time));
  check(TSGetSolution(ts, &U));
  check(TSMonitor(ts, step, time, U), run.problem.pending);
}

// TSStep says so by itself in PETSc 3.18; 3.22 leaves it to TSSolve.
void note_end(TS ts) {
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  check(TSGetConvergedReason(ts, &reason));
  if (reason == TS_CONVERGED_ITERATING) check(TSSetConvergedReason(ts, reason_of_extent(ts)));
}

// TSSolve's work before its first step.
void begin(Run& run, TS ts) {
  PetscInt step = 0;
  check(TSSetUp(ts));
  check(TSGetStepNumber(ts, &step));
  if (step == 0) check(TSRestartStep(ts));
  end_on_time(ts);
  check(TSSetConvergedReason(ts, TS_CONVERGED_ITERATING));
  check(TSViewFromOptions(ts, nullptr, "-ts_view_pre"));
  check(TSSetConvergedReason(ts, reason_of_extent(ts)));
  enter_state(run, ts);
}

// TSSolve's work on one step.
void take_step(Run& run, TS ts) {
  limit_steps(run, ts);
  check(TSPreStep(ts), run.problem.pending);
  check(TSStep(ts), run.problem.pending);
  note_end(ts);
  check(TSPostEvaluate(ts), run.problem.pending);
  check(TSPostStep(ts), run.problem.pending);
  enter_state(run, ts);
}

// Observes the last state of a run that has come to its end.
void end(Run& run, TS ts) {
  require_solved(run, ts);
  if (!run.last_observed) observe(run);
  check(TSViewFromOptions(ts, nullptr, "-ts_view"));
}

// Keeps and observes the last states when `part` of the run throws.
template <class Part>
void keep_what_there_is(Run& run, TS ts, const Part& part) {
  try {
    part();
  } catch (const Interrupted&) {
  } catch (const Insane&) {
    if (!run.last_observed) observe(run);
    throw;
  } catch (const Error&) {
    if (!run.interrupted && run.ledger.has_entries()) keep_state(run, ts);
    if (!run.interrupted && !run.last_observed) observe(run);
    if (!run.interrupted) throw;
  }
  if (!run.interrupted) return;
  if (!run.step_state.empty()) run.checkpoints.keep(run.step_state);
  if (!run.last_observed) observe(run);
}

void complete_summary(Run& run, TS ts, bool ended) {
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
  PetscInt steps = 0, rejected = 0, newton = 0;
  check(TSGetConvergedReason(ts, &reason));
  check(TSGetTime(ts, &run.summary.time));
  check(TSGetStepNumber(ts, &steps));
  check(TSGetStepRejections(ts, &rejected));
  check(TSGetSNESIterations(ts, &newton));
  run.summary.out_of_steps = ended && is_out_of_steps(ts);
  run.summary.complete = ended && reason > 0 && reason != TS_CONVERGED_USER && !run.summary.out_of_steps;
  run.summary.steps = steps;
  run.summary.rejected_steps += rejected;
  run.summary.newton_iterations += newton;
  run.summary.wall_time += seconds_since(run.start);
}

// A step that takes long is given up when the run is asked to stop.
void request_stop(Run& run) {
  if (!run.checkpoints.stop) return;
  run.problem.pulse = [&run] {
    if (!run.checkpoints.stop() || seconds_since(run.step_start) < run.checkpoints.patience) return;
    run.interrupted = true;
    throw Interrupted();
  };
  run.problem.solver.on_solve(run.problem.pulse);
}

void go_on_from(Run& run, TS ts, const std::vector<double>& state) {
  try {
    Archive archive(state);
    serialize_state(run, ts, archive);
    archive.finish();
  } catch (const Error& error) {
    throw UnfitState(std::string("the checkpoint is of other bodies or another version of the program: ") +
                     error.what());
  }
}

}  // namespace

void require_bodies_apart(System& system) {
  const auto state = [&](int i) {
    return contact::surface_state(
        system.bodies()[i].eq.body->surface,
        system.surface_motion(i, 0, system.initial_position(), system.initial_velocity()));
  };
  for (std::size_t p = 0; p < system.pairs().size(); ++p) {
    const PairSetup& pair = system.pairs()[p];
    contact::require_apart(
        contact::initial_overlap(system.detector(p), state(pair.body[0]), state(pair.body[1])), pair.name);
  }
}

RunSummary new_summary(const System& system) {
  RunSummary summary;
  for (const PairSetup& pair : system.pairs()) summary.pair.push_back({pair.name});
  return summary;
}

namespace {

// Do bodies begin with a deformation, and what is left of contact forces? Then they touch, and the static
// responses that keep their surfaces apart are not known yet.
bool begins_deformed(const System& system) {
  return std::any_of(system.bodies().begin(), system.bodies().end(),
                     [](const System::Body& body) { return !body.relaxed.empty(); });
}

}  // namespace

struct Simulation::Data {
  Data(System& system, TimeSettings time, Observer o, Progress p, Checkpoints c)
      : settings(std::move(time)),
        observer(std::move(o)),
        progress(std::move(p)),
        checkpoints(std::move(c)),
        run(system, settings, observer, progress, checkpoints) {}

  TimeSettings settings;
  Observer observer;
  Progress progress;
  Checkpoints checkpoints;
  Run run;
  UniqueVec U, V;
  UniqueMat J;
  UniqueTS ts;
  bool begun = false, ended = false, finished = false;
};

Simulation::Simulation(System& system, TimeSettings settings, Observer observer, Progress progress,
                       Checkpoints checkpoints)
    : data_(std::make_unique<Data>(system, std::move(settings), std::move(observer), std::move(progress),
                                   std::move(checkpoints))) {
  Data& d = *data_;
  validate(d.settings);
  validate(d.checkpoints);
  if (!d.settings.relax && system.any_augmented()) system.begin_step(0, 1);
  require(!d.settings.relax || !system.relaxes_in_time(), kNoHistory);
  require_tables_cover(system, d.settings.end_time);
  const bool anew = d.checkpoints.state.empty();
  if (anew && !begins_deformed(system)) require_bodies_apart(system);
  d.run.summary = new_summary(system);
  d.U = vector(system.initial_position());
  d.V = vector(system.initial_velocity());
  d.ts = make_ts(d.run, d.U, d.V, d.J);
  if (anew) {
    system.contacts(0, system.initial_position(), system.initial_velocity());
    system.accept({0, system.initial_position(), system.initial_velocity(), system.initial_velocity()});
  } else
    go_on_from(d.run, d.ts, d.checkpoints.state);
  request_stop(d.run);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

bool Simulation::advance() {
  Data& d = *data_;
  if (d.ended) return false;
  d.ended = true;  // unless all below succeeds
  keep_what_there_is(d.run, d.ts, [&d] {
    d.begun ? take_step(d.run, d.ts) : begin(d.run, d.ts);
    d.begun = true;
    TSConvergedReason reason = TS_CONVERGED_ITERATING;
    check(TSGetConvergedReason(d.ts, &reason));
    d.ended = reason != TS_CONVERGED_ITERATING;
    if (d.ended) end(d.run, d.ts);
  });
  return !d.run.interrupted;
}

bool Simulation::ended() const { return data_->ended; }

std::shared_ptr<const model::Snapshot> Simulation::state() const { return data_->run.last; }

RunSummary Simulation::finish() {
  Run& run = data_->run;
  data_->ended = true;
  if (std::exchange(data_->finished, true)) return run.summary;
  if (!run.last_observed) observe(run);
  complete_summary(run, data_->ts, !run.interrupted);
  return run.summary;
}

RunSummary simulate(System& system, const TimeSettings& settings, const Observer& observer,
                    const Progress& progress, const Checkpoints& checkpoints) {
  Simulation simulation(system, settings, observer, progress, checkpoints);
  while (simulation.advance()) continue;
  return simulation.finish();
}

}  // namespace elastogear::dynamics
