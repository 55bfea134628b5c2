#include <optional>
#include <span>
#include <utility>

#include "elastogear/base/version.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/stress.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/flexibility.h"
#include "elastogear/reduction/free_body.h"
#include "reduction/bases/ritz_bases.h"
#include "reduction/bases/ritz_task.h"
#include "reduction/basis.h"
#include "reduction/checks.h"
#include "reduction/cyclic/cyclic.h"
#include "reduction/cyclic/cyclic_masses.h"
#include "reduction/cyclic/harmonic_checkpoints.h"
#include "reduction/dense/residual.h"
#include "reduction/fingerprint.h"
#include "reduction/job/reduce_job.h"
#include "reduction/job/second_moments.h"
#include "reduction/modes/mode_checkpoints.h"
#include "reduction/static_response/attachments.h"

namespace elastogear::reduction {
namespace {

constexpr PetscInt kLargestCheckFactor = 500'000;  // displacements

// Are static responses to loads at markers coordinates?
bool attaches(const ReductionOptions& o) { return o.attachments && !o.markers.empty(); }

// Fingerprint of all that the modes depend on, but for what the solver adds. Rank 0.
Fingerprint fingerprint_of(const Job& job) {
  const ReductionOptions& o = job.options;
  Fingerprint f;
  f.add(std::string(version()) + git_hash() + o.prefix);
  for (int option : {o.n_modes, o.window, static_cast<int>(o.store), static_cast<int>(o.precision),
                     static_cast<int>(o.invariants)})
    f.add(static_cast<double>(option));
  for (const auto& [name, value] : o.solver) f.add(std::string(name).append("=").append(value));
  if (relaxes(o)) f.add(std::string("relaxing"));
  if (attaches(o)) f.add(std::string("attachments"));
  if (o.interval)
    for (double end : {o.interval->lower, o.interval->upper}) f.add(end);
  f.add_all(job.plan.moments.w_0);
  f.add_all(job.plan.moments.w_1.reshaped());
  f.add_all(job.plan.moments.modes.reshaped());
  f.add_all(job.plan.body.surface.node);
  f.add_all(job.plan.body.stress.node);
  for (const model::Marker& marker : job.plan.body.markers) f.add_all(marker.X);
  f.add_all(std::span(job.plan.S.valuePtr(), static_cast<std::size_t>(job.plan.S.nonZeros())));
  return f;
}

EigenOptions eigen_options(const ReductionOptions& o) {
  return {.n_modes = o.n_modes,
          .interval = o.interval,
          .window = o.window,
          .whole_pairs = true,
          .prefix = o.prefix};
}

void report_continued(Job& job, int checkpoints, int discarded, const std::string& what) {
  job.report.discarded = discarded;
  if (checkpoints == 0) return;
  job.report.continued_after = std::to_string(checkpoints) + " " + what;
  report(job.progress, "continues after " + job.report.continued_after, 1);
}

// Is something wanted of every pair of modes?
bool needs_pairs(const ReductionOptions& o) { return o.invariants == Invariants::full || relaxes(o); }
// Do all modes have to wait, as fields, until the last one is known?
bool needs_all(const ReductionOptions& o) { return needs_pairs(o) || attaches(o); }
bool needs_fields(const ReductionOptions& o) { return o.store == Store::all || needs_all(o); }

// Precision of fields until the body file is written.
io::Precision precision(const ReductionOptions& o) {
  return needs_all(o) ? io::Precision::float64 : o.precision;
}

// The numbers that the body keeps of a mode, and its field where that is needed too. Rank 0.
ModeRecord mode_record(const Job& job, Eigen::VectorXd phi) {
  fix_sign(phi);
  Eigen::VectorXd column = mode_column(job.plan.body, phi, job.plan.moments, job.plan.S);
  if (!needs_fields(job.options)) phi.resize(0);
  return {std::move(column), std::move(phi)};
}

void set_eigenmodes(Job& job, const Eigenmodes& modes) {
  set_modal_matrices(job.plan.body, modes.eigenvalue);
  job.plan.body.zeta = model::ratios_at(job.options.ratio, job.plan.body.frequency);
  job.report.frequency = job.plan.body.frequency;
  job.report.residual = modes.residual;
  job.report.orthogonality = modes.orthogonality;
}

// The body file of a modal basis, mode by mode. Rank 0.
class ModalWriter {
 public:
  ModalWriter(Job& job, int n_q)
      : job_(job),
        full_(job.options.store == Store::all),
        writer_(job.output, job.mesh.n_nodes(), full_ ? n_q : 0, job.options.precision) {
    allocate_modes(job.plan.body, n_q);
    if (needs_all(job.options)) waiting_.emplace(job.output + ".shapes");
  }
  void add(int k, const ModeRecord& mode) {
    set_mode(job_.plan.body, k, mode.column);
    if (full_) writer_.write_mode(k, mode.phi);
    if (waiting_) waiting_->add(k, mode.phi);
  }
  // All modes so far.
  const WaitingModes& modes() {
    waiting_->close();
    return *waiting_;
  }
  void attach(const Attachments& found) {
    model::ElasticBody& body = job_.plan.body;
    const auto n_q = static_cast<int>(body.n_q()), n_a = static_cast<int>(found.eigenvalue.size());
    Eigen::VectorXd eigenvalue(n_q + n_a);
    eigenvalue << body.K_r.diagonal(), found.eigenvalue;
    set_modal_matrices(body, eigenvalue);
    body.zeta = model::ratios_at(job_.options.ratio, body.frequency);
    body.n_attachments = n_a;
    job_.report.attachment = body.frequency.tail(n_a);
    add_modes(body, n_a);
    if (full_) writer_.add_modes(n_a);
    for (int k = 0; k < n_a; ++k) add(n_q + k, mode_record(job_, found.phi.col(k)));
  }
  // Takes the columns of static responses as they are found.
  ColumnSink responses() {
    return [this](const model::Flexibility& plan, Eigen::Index, const Eigen::MatrixXf& F,
                  const Eigen::MatrixXf& G) { writer_.write_responses(plan, F, G); };
  }
  void finish() {
    if (needs_pairs(job_.options)) set_pairs(*waiting_);
    model::Flexibility& flexibility = job_.plan.body.flexibility;
    if (flexibility.F.size() == 0) flexibility.read_F = writer_.written_responses();
    writer_.finish(job_.plan.body, source_of(job_), {job_.report.residual, job_.report.orthogonality});
    flexibility.read_F = {};
  }

 private:
  void set_pairs(WaitingModes& modes) {
    modes.close();
    if (job_.options.invariants == Invariants::full)
      job_.plan.body.inertia.S_2 = second_moments(modes, field_mass(job_));
    set_relaxing(job_, modes);
  }

  Job& job_;
  bool full_;
  io::BodyWriter writer_;
  std::optional<WaitingModes> waiting_;
};

// Adds the static responses to loads at markers to the modes, which all are written. whole: the whole body;
// null for a held one that repeats. Collective.
void attach(Job& job, const ElasticSystem* whole, std::optional<ModalWriter>& writer) {
  if (!attaches(job.options)) return;
  job.begin_stage("static responses to loads at markers");
  const WaitingModes* modes = nullptr;
  job.on_root([&] { modes = &writer->modes(); });
  const Attachments found = find_attachments(job, whole, modes);
  job.on_root([&] { writer->attach(found); });
}

// The other ranks have no writer.
ColumnSink responses_to(std::optional<ModalWriter>& writer) {
  return writer ? writer->responses() : ColumnSink{};
}

Eigenmodes find_modes(Job& job, const ElasticSystem& system, ModeCheckpoints& checkpoints) {
  PetscInt n_own = 0;
  check(MatGetLocalSize(system.K, &n_own, nullptr));
  const auto keep = [&](int k, Vec v) {
    Eigen::VectorXd phi = system.gather(v);
    job.on_root([&] { checkpoints.add(k, mode_record(job, std::move(phi))); });
  };
  EigenOptions options = eigen_options(job.options);
  options.start = checkpoints.resume(static_cast<int>(n_own));
  options.commit = [&](const SearchState& state) { checkpoints.commit(state); };
  report_continued(job, static_cast<int>(options.start.eigenvalue.size()), checkpoints.discarded(),
                   options.interval ? "modes" : "of " + std::to_string(options.n_modes) + " modes");
  return system.rigid ? find_free_modes(system.K, system.M, *system.rigid, options, keep, job.progress)
                      : find_eigenmodes(system.K, system.M, options, keep, job.progress);
}

std::string fingerprint_of(Job& job, const fem::Matrices& matrices) {
  Fingerprint f;
  job.on_root([&] {
    f = fingerprint_of(job);
    f.add_all(job.plan.dof);
  });
  for (std::uint64_t word : {fingerprint(matrices.K), fingerprint(matrices.M)}) f.add(word);
  return f.text();
}

// Static responses on all of the surface leave nothing to ask of the modes.
bool asks_for_completeness(const ReductionOptions& o) {
  return o.completeness && !without_modes(o) && !(o.flexibility && o.loaded.empty());
}

void add_load_checks(Job& job, const ElasticSystem& system) {
  for (model::Check& check : load_checks(system, job.plan.body, job.mesh.n_nodes()))
    job.report.checks.push_back(std::move(check));
}

void check_basis(Job& job, const ElasticSystem& system, bool completeness) {
  if (without_modes(job.options)) return;
  job.begin_stage("checks");
  const Plan& plan = job.plan;
  job.report.checks = mass_checks(system.rigid != nullptr, plan.body, [&] {
    return mobile_masses(system.M, system.gather, plan.moments, plan.body.inertia.c);
  });
  if (completeness) add_load_checks(job, system);
}

// From the matrices of the whole body.
void reduce_whole(Job& job) {
  const fem::Matrices matrices = assemble(job);
  job.begin_stage("eigenmodes");
  UniqueVec layout;
  check(MatCreateVecs(matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, job.plan.dof, 3 * job.mesh.n_nodes());
  std::optional<RigidModes> rigid;
  if (job.options.floating) rigid = find_rigid_modes(matrices.K, matrices.M, gather, job.mesh.X);
  const ElasticSystem system{matrices.K, matrices.M, gather, rigid ? &*rigid : nullptr};
  ModeCheckpoints checkpoints(job.comm, job.output + ".partial", fingerprint_of(job, matrices),
                              precision(job.options));
  set_eigenmodes(job, without_modes(job.options) ? Eigenmodes{} : find_modes(job, system, checkpoints));
  std::optional<ModalWriter> writer;
  job.on_root([&] {
    const auto n_q = static_cast<int>(job.report.frequency.size());
    writer.emplace(job, n_q);
    checkpoints.visit([&](int k, const ModeRecord& mode) {
      if (k < n_q) writer->add(k, mode);  // later ones are void
    });
  });
  check_basis(job, system, asks_for_completeness(job.options));
  add_flexibility(job, &system, responses_to(writer));
  attach(job, &system, writer);
  job.begin_stage("writing");
  job.on_root([&] { writer->finish(); });
  checkpoints.clear();
}

std::string fingerprint_of_sectors(Job& job) {
  Fingerprint f;
  job.on_root([&] {
    f = fingerprint_of(job);
    f.add_all(job.mesh.X.reshaped());
    f.add_all(job.plan.is_free);
    f.add_all(job.plan.region);
    for (const model::MaterialRegion& region : job.regions) add(f, region.material);
    f.add(static_cast<double>(job.options.element));
    f.add(static_cast<double>(job.options.element_mass));
  });
  return f.text();
}

SixDirections mobile_masses_by_sectors(const Job& job) {
  const Plan& plan = job.plan;
  return cyclic_mobile_masses(job.comm, meshed_body(job), plan.repetition, plan.moments, plan.body.inertia.c);
}

// Completeness takes a factor of the whole body, which is left out where it would take more memory than all
// else. Collective.
bool completeness_of_sectors(const Job& job) {
  int few = job.rank == 0 && job.plan.free_dof.size() <= kLargestCheckFactor;
  MPI_Bcast(&few, 1, MPI_INT, 0, job.comm);
  return asks_for_completeness(job.options) && few != 0;
}

// The modes of sectors need no matrices of the whole body, and neither do their masses nor static responses
// that repeat as well: K and M are assembled where something else asks for them.
void check_sectors(Job& job, std::optional<ModalWriter>& writer) {
  const bool completeness = completeness_of_sectors(job);
  const bool whole = completeness || (job.options.flexibility && !flexibility_repeats(job));
  const fem::Matrices matrices = whole ? assemble(job) : fem::Matrices{};
  std::optional<fem::VectorGather> gather;
  std::optional<ElasticSystem> system;
  if (whole) {
    UniqueVec layout;
    check(MatCreateVecs(matrices.K, layout.out(), nullptr));
    gather.emplace(layout, job.plan.dof, 3 * job.mesh.n_nodes());
    system.emplace(ElasticSystem{matrices.K, matrices.M, *gather, nullptr});
  }
  if (!without_modes(job.options)) {
    job.begin_stage("checks");
    job.report.checks = mass_checks(false, job.plan.body, [&] { return mobile_masses_by_sectors(job); });
  }
  if (completeness) add_load_checks(job, *system);
  add_flexibility(job, system ? &*system : nullptr, responses_to(writer));
  attach(job, system ? &*system : nullptr, writer);
}

Eigenmodes find_modes_of_sectors(Job& job, HarmonicCheckpoints& checkpoints,
                                 std::optional<ModalWriter>& writer) {
  const fem::MeshedBody body = meshed_body(job);
  CyclicOptions options;
  options.eigen = eigen_options(job.options);
  options.known = [&](int k, double cutoff) { return checkpoints.read(k, cutoff); };
  options.done = [&](const HarmonicModes& modes) { checkpoints.write(modes); };
  options.begin = [&](int n_q) { job.on_root([&] { writer.emplace(job, n_q); }); };
  report_continued(job, checkpoints.n_known(), checkpoints.discarded(), "harmonics");
  const auto keep = [&](int k, const Eigen::VectorXd& phi) {
    job.on_root([&] { writer->add(k, mode_record(job, phi)); });
  };
  return find_cyclic_eigenmodes(job.comm, {body, job.plan.repetition}, options, keep, job.progress);
}

// From one sector of a cyclically symmetric body.
void reduce_sectors(Job& job) {
  job.begin_stage("eigenmodes");
  HarmonicCheckpoints checkpoints(job.comm, job.output + ".partial", fingerprint_of_sectors(job));
  std::optional<ModalWriter> writer;
  if (without_modes(job.options))
    job.on_root([&] { writer.emplace(job, 0); });
  else
    set_eigenmodes(job, find_modes_of_sectors(job, checkpoints, writer));
  check_sectors(job, writer);
  job.begin_stage("writing");
  job.on_root([&] { writer->finish(); });
  checkpoints.clear();
}

// Reduces the body by Ritz vectors in place of eigenmodes.
void reduce_ritz(Job& job) {
  const fem::Matrices matrices = assemble(job);
  UniqueVec layout;
  check(MatCreateVecs(matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, job.plan.dof, 3 * job.mesh.n_nodes());
  job.begin_stage("Ritz vectors");
  const ElasticSystem system{matrices.K, matrices.M, gather, nullptr};
  const BlockProduct K(matrices.K), M(matrices.M, BlockProduct::Storage::without_zeros);
  const RitzSpace space = find_space(ritz_task(job, system, eigen_options(job.options)), K, M, job.progress);
  std::optional<ModalWriter> writer;
  job.on_root([&] { writer.emplace(job, space.size); });
  const auto keep = [&](int k, Vec v) {
    Eigen::VectorXd phi = gather(v);
    job.on_root([&] { writer->add(k, mode_record(job, std::move(phi))); });
  };
  const RitzVectors ritz = ritz_vectors(space);
  Eigenmodes modes = deliver(space, ritz, matrices.K, matrices.M, keep);
  require_definite(matrices.K, matrices.M, modes.eigenvalue(0));
  const Eigen::VectorXd residual = std::exchange(modes.residual, {});
  set_eigenmodes(job, modes);
  check_basis(job, system, asks_for_completeness(job.options));
  job.report.checks.push_back(ritz_check(residual));
  job.begin_stage("writing");
  job.on_root([&] { writer->finish(); });
}

}  // namespace

void reduce_modal(Job& job) {
  if (job.options.ritz) return reduce_ritz(job);
  announce_flexibility(job);
  job.modes_by_sectors() ? reduce_sectors(job) : reduce_whole(job);
}

}  // namespace elastogear::reduction
