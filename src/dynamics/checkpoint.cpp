#include "elastogear/dynamics/generalized_alpha.h"
#include "run.h"
#include "vec_view.h"

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

// Another nominal step than that of the stored run is what the user wants now.
void set_instant(Run& run, TS ts, const Instant& then) {
  check(TSSetTime(ts, then.time));
  check(TSSetStepNumber(ts, then.step));
  if (then.nominal_dt == run.nominal_dt) check(TSSetTimeStep(ts, then.dt));
  run.entered_step = then.step;
  run.summary.rejected_steps = then.rejected;
  run.summary.newton_iterations = then.newton;
}

void visit_instant(Run& run, TS ts, Tape& tape) {
  Instant at;
  if (!tape.plays()) at = instant(run, ts);
  for (double* x : {&at.time, &at.dt, &at.nominal_dt}) tape(*x);
  for (PetscInt* n : {&at.step, &at.rejected, &at.newton}) tape(*n);
  if (tape.plays()) set_instant(run, ts, at);
}

void visit_summary(RunSummary& summary, Tape& tape) {
  tape(summary.most_contacts);
  tape(summary.initial_energy);
  tape(summary.largest_imbalance);
  tape.each(summary.pair, [&](PairSummary& pair) {
    tape(pair.peak_force);
    tape(pair.peak_time);
    tape(pair.penetration);
    tape(pair.patch_nodes);
  });
}

void visit_motion(TS ts, Tape& tape) {
  Vec motion[3];
  if (tape.plays())
    check(TS2GetSolution(ts, &motion[0], &motion[1]));
  else
    generalized_alpha_state(ts, &motion[0], &motion[1], &motion[2]);
  UniqueVec A;
  if (tape.plays()) {
    check(VecDuplicate(motion[0], A.out()));
    motion[2] = A;
  }
  for (Vec x : motion) {
    Eigen::VectorXd values = *ReadView(x);
    const Eigen::Index n = values.size();
    tape(values);
    require(values.size() == n, "the stored state has ", values.size(), " coordinates, this run ", n);
    if (tape.plays()) assign(x, values);
  }
  if (tape.plays()) generalized_alpha_set_state(ts, motion[0], motion[1], motion[2]);
}

}  // namespace

void visit_state(Run& run, TS ts, Tape& tape) {
  visit_instant(run, ts, tape);
  visit_motion(ts, tape);
  run.problem.system.visit_memory(tape);
  run.problem.solver.visit_memory(tape);
  run.ledger.visit_memory(tape);
  run.sanity.visit_memory(tape);
  tape(run.kinetic_energy);
  tape(run.n_outputs);
  tape(run.touches);
  tape(run.short_steps);
  tape(run.longest_short);
  visit_summary(run.summary, tape);
  double wall_time = run.summary.wall_time + seconds_since(run.start);
  tape(wall_time);
  if (tape.plays()) run.summary.wall_time = wall_time;
}

std::vector<double> state_now(Run& run, TS ts) {
  Tape tape;
  visit_state(run, ts, tape);
  return tape.numbers();
}

void keep_state(Run& run, TS ts) {
  if (!run.checkpoints.keep) return;
  run.checkpoints.keep(state_now(run, ts));
  run.kept = Clock::now();
}

}  // namespace elastogear::dynamics
