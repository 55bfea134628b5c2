#include <optional>
#include <utility>

#include "reduction/job/reduce_job.h"

namespace elastogear::reduction {
namespace {

constexpr const char* kRelaxedResponses = "static responses of relaxed states";

FlexibilityTask flexibility_task(const Job& job) {
  const model::ElasticBody& body = job.plan.body;
  return {body.surface,        body.stress.node,   job.plan.S,        job.mesh,
          job.plan.repetition, job.options.loaded, stressed_body(job)};
}

// Each state of relaxation takes as long, and what it has found stays in memory.
void add_states(StaticResponseCost& cost, int n_states) {
  cost.n_states = n_states;
  cost.seconds *= 1 + n_states;
  cost.bytes += n_states * cost.kept_bytes;
}

// Static responses of the body with the present moduli of job.regions. system: of the whole body; none where
// they repeat. Collective.
model::Flexibility solve_flexibility(Job& job, const FlexibilityTask& task, const ElasticSystem* system,
                                     const ColumnSink& sink = {}) {
  return system == nullptr ? find_cyclic_flexibility(job.comm, task, meshed_body(job), job.options.floating,
                                                     sink, job.progress)
                           : find_flexibility(task, *system, job.progress);
}

// Adds the static responses of one state of relaxation, Eqs. (2.21) and (4.12), with the amplitudes of
// incompatible modes and the mass of the instantaneous moduli. system: as above, instantaneous. Collective.
void add_relaxed(Job& job, const ElasticSystem* system, const Eigen::VectorXd& share,
                 model::Flexibility& flexibility) {
  const std::vector<model::MaterialRegion> instantaneous = job.regions;
  set_relaxed(job.regions, share);
  const FlexibilityTask task = flexibility_task(job);
  fem::Matrices matrices;
  std::optional<ElasticSystem> relaxed_system;
  if (system != nullptr) {
    matrices = assemble(job);
    relaxed_system.emplace(ElasticSystem{matrices.K, system->M, system->gather, system->rigid});
  }
  job.begin_stage(kRelaxedResponses);
  model::Flexibility relaxed = solve_flexibility(job, task, relaxed_system ? &*relaxed_system : nullptr);
  job.on_root([&] {
    relax_stresses(job, stress_nodes(task, relaxed), relaxed.G);
    flexibility.relaxed.push_back({share, std::move(relaxed.self), std::move(relaxed.F)});
    const Eigen::Index above = flexibility.G.rows();
    flexibility.G.conservativeResize(above + relaxed.G.rows(), Eigen::NoChange);
    flexibility.G.bottomRows(relaxed.G.rows()) = relaxed.G;
  });
  job.regions = instantaneous;
}

// Does the body relax in different ratios? Collective.
bool relaxes_in_ratios(Job& job) {
  int apart = 0;
  job.on_root([&] { apart = relaxes(job.options) && !relaxes_alike(job); });
  MPI_Bcast(&apart, 1, MPI_INT, 0, job.comm);
  return apart != 0;
}

}  // namespace

fem::MeshedBody meshed_body(const Job& job) {
  return {job.mesh, job.regions, job.plan.region, job.plan.is_free, formulation(job)};
}

void announce_flexibility(Job& job) {
  if (!job.options.flexibility || !job.options.announce) return;
  job.on_root([&] {
    const FlexibilityTask task = flexibility_task(job);
    StaticResponseCost cost = forecast(task, plan_flexibility(task), job.plan.free_dof.size(), job.size);
    if (relaxes(job.options) && !relaxes_alike(job)) add_states(cost, relaxed_states(job).size());
    job.options.announce(cost);
  });
}

bool flexibility_repeats(Job& job) {
  int repeats = 0;
  if (job.cyclic()) job.on_root([&] { repeats = plan_flexibility(flexibility_task(job)).n_sectors > 1; });
  MPI_Bcast(&repeats, 1, MPI_INT, 0, job.comm);
  return repeats != 0;
}

void add_flexibility(Job& job, const ElasticSystem* whole, const ColumnSink& sink) {
  if (!job.options.flexibility) return;
  const ElasticSystem* const system = flexibility_repeats(job) ? nullptr : whole;
  const bool has_states = relaxes_in_ratios(job);  // G gets their rows, too
  job.begin_stage("static responses");
  model::Flexibility flexibility =
      solve_flexibility(job, flexibility_task(job), system, has_states ? ColumnSink{} : sink);
  if (has_states) {
    job.begin_stage(kRelaxedResponses);
    const RelaxedStates states = relaxed_states(job);
    flexibility.law = states.law;
    for (int k = 0; k < states.size(); ++k) add_relaxed(job, system, states.share.col(k), flexibility);
  } else if (relaxes(job.options)) {
    flexibility.creep = 0;
  }
  if (job.rank == 0) job.plan.body.flexibility = std::move(flexibility);
}

}  // namespace elastogear::reduction
