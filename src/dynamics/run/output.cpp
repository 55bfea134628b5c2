// Observing a run: at steps, or at given times between them.
#include <algorithm>
#include <limits>

#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace {

constexpr double kSameTime = 1e-9;  // of a step: roundoff in times

Eigen::Ref<const Eigen::VectorXd> elastic(const System::Body& body, ConstVector x) {
  return x.segment(body.first + body.n_open(), body.eq.n_q());
}

void start_time_errors(Run& run, const State& x) {
  for (std::size_t b = 0; b < run.time_error.size(); ++b) {
    const System::Body& body = run.problem.system.bodies()[b];
    if (run.time_error[b].size() > 0)
      run.time_error[b].start(x.time, {elastic(body, x.U), elastic(body, x.V), elastic(body, x.A)});
  }
}

// States between the ends of the last step have errors of their own.
void add_time_errors(Run& run, const State& x, model::Snapshot& now) {
  for (std::size_t b = 0; b < run.time_error.size(); ++b) {
    const TimeError& error = run.time_error[b];
    if (error.size() == 0) continue;
    now.bodies[b].q_error =
        x.time < error.end_time() ? error.within(x.time, now.bodies[b].q) : error.at_end();
  }
}

// Enters a state into a ledger and the summary. A state that Sanity rejects does not become the last state.
void enter(Run& run, EnergyLedger& ledger, const State& x) {
  model::Snapshot now = snapshot(run.problem.system, x);
  add_time_errors(run, x, now);
  ledger.enter(run.problem.system, now);
  try {
    run.sanity.require_small(now);
    if (!run.settings.relax) run.sanity.require_balance(now.time, now.energy);
  } catch (const Error& error) {
    throw Insane(error.what());
  }
  run.last = std::make_shared<const model::Snapshot>(std::move(now));
  run.last_observed = false;
  update(run.summary, *run.last);
  run.summary.turned_over = run.sanity.turned_over();
}

// Solves for the state, for contact is too stiff to tell its forces from interpolated coordinates. Forces of
// impacts are known for whole steps alone.
void find_between(Run& run, TS ts, double time, const MotionVectors& x) {
  try {
    if (!run.problem.system.any_augmented() && generalized_alpha_solve_between(ts, time, x)) return;
  } catch (const Error& error) {
    check(0, run.problem.pending);
    require(run.problem.trouble.empty(), error.what(), ": ", run.problem.trouble);
    throw;
  }
  generalized_alpha_interpolate(ts, time, x);
}

void observe_between(Run& run, TS ts, double time) {
  Vec U = nullptr;
  UniqueVec u, v, a;
  check(TSGetSolution(ts, &U));
  for (UniqueVec* x : {&u, &v, &a}) check(VecDuplicate(U, x->out()));
  find_between(run, ts, time, {u, v, a});
  const ReadView at_u(u), at_v(v), at_a(a);
  EnergyLedger until = run.ledger;  // the run's own one knows ends of steps alone, whatever is observed
  enter(run, until, {time, *at_u, *at_v, *at_a});
  observe(run);
}

// The acceleration may have to be solved for. What a callback throws then goes before PETSc's error.
void find_state(Run& run, TS ts, Vec* U, Vec* V, Vec* A) {
  try {
    generalized_alpha_state(ts, U, V, A);
  } catch (const Error&) {
    check(0, run.problem.pending);
    throw;
  }
}

bool has_output_times(const TimeSettings& settings) {
  return settings.output_dt > 0 || !settings.output_times.empty();
}

// The i-th time of output after the start; infinite: there is none.
double output_time(const TimeSettings& settings, int i) {
  if (settings.output_dt > 0) return i * settings.output_dt;
  const auto k = static_cast<std::size_t>(i - 1);
  return k < settings.output_times.size() ? settings.output_times[k]
                                          : std::numeric_limits<double>::infinity();
}

bool is_due(const Run& run, int step) {
  return step == 0 ||
         (has_output_times(run.settings) ? run.step_is_due : step % run.settings.output_every == 0);
}

// Active contacts of the area of contact that has most of them.
int largest_patch(const model::PairState& pair) {
  int most = 0;
  for (const auto& areas : pair.area)
    for (const model::ContactFigures& area : areas) most = std::max(most, area.count);
  return most;
}

}  // namespace

void update(RunSummary& summary, const model::Snapshot& snapshot) {
  int contacts = 0;
  for (std::size_t p = 0; p < snapshot.pairs.size(); ++p) {
    const model::PairState& pair = snapshot.pairs[p];
    PairSummary& entry = summary.pair[p];
    contacts += pair.count;
    entry.penetration = std::max(entry.penetration, pair.penetration);
    if (pair.force.norm() > entry.peak_force) {
      entry.peak_force = pair.force.norm();
      entry.peak_time = snapshot.time;
      entry.patch_nodes = largest_patch(pair);
    }
  }
  summary.work = snapshot.energy.work;
  summary.most_contacts = std::max(summary.most_contacts, contacts);
  summary.largest_imbalance = std::max(summary.largest_imbalance, std::abs(snapshot.energy.balance));
}

void observe(Run& run) {
  if (run.observer) run.observer(*run.last);
  run.last_observed = true;
}

bool has_due_state(const Run& run) { return !has_output_times(run.settings) || run.step_is_due; }

double next_output(const Run& run, double time) {
  if (!has_output_times(run.settings)) return std::numeric_limits<double>::infinity();
  int i = run.n_outputs;
  while (output_time(run.settings, i) <= time) ++i;
  return output_time(run.settings, i);
}

void observe_since_last_step(Run& run, TS ts) {
  PetscReal time = 0, before = 0;
  if (!has_output_times(run.settings)) return;
  check(TSGetTime(ts, &time));
  check(TSGetPrevTime(ts, &before));
  const double same = kSameTime * (time - before);
  run.step_is_due = false;
  for (;; ++run.n_outputs) {
    const double due = output_time(run.settings, run.n_outputs);
    if (due > time + same) return;
    if (due <= 0) continue;  // the start, which has been observed
    if (due >= time - same)
      run.step_is_due = true;
    else
      observe_between(run, ts, due);
  }
}

std::vector<TimeError> new_time_errors(const System& system) {
  std::vector<TimeError> errors;
  for (const System::Body& body : system.bodies()) {
    const body::Equations& eq = body.eq;
    const bool modal = eq.body->basis == model::Basis::modal;
    errors.emplace_back(modal
                            ? Oscillators{eq.body->M_r.diagonal(), eq.D_r.diagonal(), eq.body->K_r.diagonal()}
                            : Oscillators{});
  }
  return errors;
}

void follow_time_errors(Run& run, TS ts) {
  if (run.time_error.empty()) return;
  const LastStep last = generalized_alpha_last_step(ts);
  const ReadView U_0(last.start.U), V_0(last.start.V), A_0(last.start.A), U_1(last.end.U), V_1(last.end.V),
      A_1(last.end.A);
  const bool had_impulse = run.problem.system.had_impulse();
  for (std::size_t b = 0; b < run.time_error.size(); ++b) {
    const System::Body& body = run.problem.system.bodies()[b];
    if (run.time_error[b].size() == 0) continue;
    run.time_error[b].follow({last.time,
                              last.size,
                              last.alpha_m,
                              last.alpha_f,
                              {elastic(body, *U_0), elastic(body, *V_0), elastic(body, *A_0)},
                              {elastic(body, *U_1), elastic(body, *V_1), elastic(body, *A_1)}},
                             had_impulse);
  }
}

void enter_step(Run& run, TS ts, int step, double time) {
  Vec U = nullptr, V = nullptr, A = nullptr;
  find_state(run, ts, &U, &V, &A);
  const ReadView u(U), v(V), a(A);
  if (step == 0) start_time_errors(run, {time, *u, *v, *a});
  enter(run, run.ledger, {time, *u, *v, *a});
  follow_displacement(run);
  run.touches = std::any_of(run.last->pairs.begin(), run.last->pairs.end(),
                            [](const model::PairState& pair) { return pair.count > 0; });
  const model::Energies& energy = run.last->energy;
  run.energy = energy.kinetic + energy.elastic;
  if (step == 0)
    run.summary.initial_energy = energy.kinetic + energy.elastic + energy.contact + energy.bushing;
  if (is_due(run, step)) observe(run);
}

void report_step(const Run& run, TS ts, int step) {
  StepInfo info{.step = step,
                .time = run.last->time,
                .unbalanced = run.unbalanced,
                .balance = run.last->energy.balance};
  PetscInt newton = 0;
  check(TSGetTimeStep(ts, &info.dt));
  check(TSGetSNESIterations(ts, &newton));
  info.newton_iterations = run.summary.newton_iterations + newton;
  for (const model::PairState& pair : run.last->pairs) {
    info.contacts += pair.count;
    info.penetration = std::max(info.penetration, pair.penetration);
  }
  if (run.settings.monitor) run.settings.monitor(info);
}

}  // namespace elastogear::dynamics
