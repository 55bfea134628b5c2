#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace {

struct Instant {
  PetscReal time = 0, dt = 0, nominal_dt = 0;
  PetscInt step = 0, rejected = 0, newton = 0;
};

Instant instant(const Run& run, TS ts) {
  Instant now;
  now.nominal_dt = run.nominal_dt;
  check(TSGetTime(ts, &now.time));
  check(TSGetTimeStep(ts, &now.dt));
  check(TSGetStepNumber(ts, &now.step));
  check(TSGetStepRejections(ts, &now.rejected));
  check(TSGetSNESIterations(ts, &now.newton));
  now.rejected += run.summary.rejected_steps;
  now.newton += run.summary.newton_iterations;
  return now;
}

// Puts the run back to a stored instant, with its step size unless the user has asked for another nominal
// step since.
void set_instant(Run& run, TS ts, const Instant& then) {
  check(TSSetTime(ts, then.time));
  check(TSSetStepNumber(ts, then.step));
  if (then.nominal_dt == run.nominal_dt) check(TSSetTimeStep(ts, then.dt));
  run.entered_step = then.step;
  run.summary.rejected_steps = then.rejected;
  run.summary.newton_iterations = then.newton;
}

void serialize_instant(Run& run, TS ts, Archive& archive) {
  Instant at;
  if (!archive.is_loading()) at = instant(run, ts);
  for (double* x : {&at.time, &at.dt, &at.nominal_dt}) archive(*x);
  for (PetscInt* n : {&at.step, &at.rejected, &at.newton}) archive(*n);
  if (archive.is_loading()) set_instant(run, ts, at);
}

void serialize_summary(RunSummary& summary, Archive& archive) {
  archive(summary.most_contacts);
  archive(summary.initial_energy);
  archive(summary.largest_imbalance);
  archive.each(summary.pair, [&](PairSummary& pair) {
    archive(pair.peak_force);
    archive(pair.peak_time);
    archive(pair.penetration);
    archive(pair.patch_nodes);
  });
}

void serialize_motion(TS ts, Archive& archive) {
  Vec motion[3];
  if (archive.is_loading())
    check(TS2GetSolution(ts, &motion[0], &motion[1]));
  else
    generalized_alpha_state(ts, &motion[0], &motion[1], &motion[2]);
  UniqueVec A;
  if (archive.is_loading()) {
    check(VecDuplicate(motion[0], A.out()));
    motion[2] = A;
  }
  for (Vec x : motion) {
    Eigen::VectorXd values = *ReadView(x);
    const Eigen::Index n = values.size();
    archive(values);
    require(values.size() == n, "the stored state has ", values.size(), " coordinates, this run ", n);
    if (archive.is_loading()) assign(x, values);
  }
  if (archive.is_loading()) generalized_alpha_set_state(ts, motion[0], motion[1], motion[2]);
}

void serialize_history(TS ts, Archive& archive) {
  const StepHistory history = generalized_alpha_history(ts);
  Eigen::VectorXd slope = *ReadView(history.slope);
  archive(slope);
  archive(*history.step);
  if (archive.is_loading()) assign(history.slope, slope);
}

}  // namespace

void serialize_state(Run& run, TS ts, Archive& archive) {
  serialize_instant(run, ts, archive);
  serialize_motion(ts, archive);
  serialize_history(ts, archive);
  run.problem.system.serialize(archive);
  run.problem.solver.serialize(archive);
  run.ledger.serialize(archive);
  run.sanity.serialize(archive);
  for (TimeError& error : run.time_error) error.serialize(archive);
  archive(run.kinetic_energy);
  archive(run.n_outputs);
  archive(run.touches);
  archive(run.energy);
  archive(run.control.displacement);
  archive(run.control.stress);
  archive(run.short_steps);
  archive(run.longest_short);
  serialize_summary(run.summary, archive);
  double wall_time = run.summary.wall_time + seconds_since(run.start);
  archive(wall_time);
  if (archive.is_loading()) run.summary.wall_time = wall_time;
}

std::vector<double> state_now(Run& run, TS ts) {
  Archive archive;
  serialize_state(run, ts, archive);
  return archive.numbers();
}

// Before the first step there is nothing to go on from, and nothing that a run with other input could lose.
void keep_state(Run& run, TS ts) {
  PetscInt steps = 0;
  check(TSGetStepNumber(ts, &steps));
  if (!run.checkpoints.keep || steps == 0) return;
  run.checkpoints.keep(state_now(run, ts));
  run.kept = Clock::now();
}

}  // namespace elastogear::dynamics
