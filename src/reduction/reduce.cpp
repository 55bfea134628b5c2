#include "elastogear/reduction/reduce.h"

#include <algorithm>
#include <optional>
#include <set>
#include <span>

#include "elastogear/base/agree.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/version.h"
#include "elastogear/fem/assembly.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stress.h"
#include "elastogear/io/body_file.h"
#include "elastogear/mesh/partition.h"
#include "elastogear/reduction/basis.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/surface.h"
#include "fingerprint.h"
#include "mode_pieces.h"

namespace elastogear::reduction {
namespace {

// What rank 0 alone knows: the numbering, and everything of the body that needs no solution.
struct Plan {
  std::vector<int> region;  // of each cell
  std::vector<int> free_dof;
  mesh::Partition partition;
  fem::RowNumbering rows;
  fem::MassMoments moments;
  model::SparseRows S;
  model::ElasticBody body;
};

struct Job {
  MPI_Comm comm;
  const mesh::Mesh& mesh;
  const ReductionOptions& options;
  const std::string& output;
  const Progress& progress;
  int rank = 0, size = 1;
  Plan plan = {};
  ReductionReport report = {};
  double started = MPI_Wtime();

  bool modal() const { return options.basis == model::Basis::modal; }

  // Runs `f` on rank 0; its errors reach all ranks.
  void on_root(const std::function<void()>& f) {
    agree(comm, [&] {
      if (rank == 0) f();
    });
  }

  void finish_stage(const char* stage) {
    const double now = MPI_Wtime();
    report.times.push_back({stage, now - started});
    started = now;
  }
};

model::Stress make_stress(const mesh::Mesh& mesh, const std::vector<std::string>& sets) {
  std::set<int> nodes;
  for (const std::string& name : sets) {
    const auto& members = mesh::node_set(mesh, name);
    nodes.insert(members.begin(), members.end());
  }
  model::Stress stress;
  stress.node.assign(nodes.begin(), nodes.end());
  stress.X = mesh.X(Eigen::all, stress.node);
  for (const std::string& name : sets) {
    auto& local = stress.sets[name];
    local.clear();
    for (int node : mesh::node_set(mesh, name))
      local.push_back(static_cast<int>(std::lower_bound(stress.node.begin(), stress.node.end(), node) -
                                       stress.node.begin()));
  }
  return stress;
}

model::ElasticBody make_body(const mesh::Mesh& mesh, const ReductionOptions& options,
                             const fem::MassMoments& moments) {
  model::ElasticBody body;
  body.name = options.name;
  body.inertia = fem::rigid_inertia(mesh, moments);
  body.alpha = options.alpha;
  body.beta = options.beta;
  body.surface = make_surface(mesh, options.regions, options.surface);
  body.stress = make_stress(mesh, options.stress_nodes);
  body.provenance = options.provenance;
  return body;
}

void validate(const ReductionOptions& options) {
  fem::validate(options.regions);
  require(options.alpha >= 0, "damping alpha = ", options.alpha, " 1/s, must not be negative");
  require(options.beta >= 0, "damping beta = ", options.beta, " s, must not be negative");
}

void number(Job& job) {
  const mesh::Mesh& mesh = job.mesh;
  Plan& plan = job.plan;
  validate(job.options);
  fem::require_positive_jacobians(mesh);
  plan.region = fem::cell_regions(mesh, job.options.regions);
  const std::vector<bool> is_free = fem::free_nodes(mesh, job.options.restrain);
  fem::require_held(mesh, is_free);
  plan.free_dof = fem::free_dofs(is_free);
  require(!plan.free_dof.empty(), "all nodes are restrained, no degree of freedom is left");
  if (job.modal()) require_mode_count(job.options.n_modes, static_cast<int>(plan.free_dof.size()));
  plan.partition = mesh::partition_cells(mesh, job.size);
  plan.rows = fem::number_rows(mesh, is_free, plan.partition.part, job.size);
}

void prepare_body(Job& job) {
  Plan& plan = job.plan;
  plan.moments = fem::mass_moments(job.mesh, job.options.regions);
  plan.body = make_body(job.mesh, job.options, plan.moments);
  plan.S = fem::stress_operator(job.mesh, job.options.regions, job.options.element, plan.body.stress.node);
  const PendingFile can_be_written(job.output);
}

// What the modes depend on. Collective.
std::string fingerprint_of(Job& job, const fem::Matrices& matrices) {
  const ReductionOptions& o = job.options;
  Fingerprint f;
  f.add(std::string(version()) + git_hash() + o.prefix);
  for (std::uint64_t word : {fingerprint(matrices.K), fingerprint(matrices.M)}) f.add(word);
  for (int option : {o.n_modes, o.window, static_cast<int>(o.store), static_cast<int>(o.precision)})
    f.add(static_cast<double>(option));
  f.add_all(job.plan.rows.row);
  f.add_all(job.plan.moments.w_0);
  f.add_all(job.plan.moments.w_1.reshaped());
  f.add_all(job.plan.body.surface.node);
  f.add_all(job.plan.body.stress.node);
  f.add_all(std::span(job.plan.S.valuePtr(), static_cast<std::size_t>(job.plan.S.nonZeros())));
  return f.text();
}

EigenOptions eigen_options(Job& job, ModePieces& pieces, const fem::Matrices& matrices) {
  EigenOptions options;
  PetscInt n_own = 0;
  check(MatGetLocalSize(matrices.K, &n_own, nullptr));
  options.n_modes = job.options.n_modes;
  options.window = job.options.window;
  options.prefix = job.options.prefix;
  options.whole_pairs = true;
  options.start = pieces.resume(static_cast<int>(n_own));
  options.commit = [&](const SearchState& state) { pieces.commit(state); };
  job.report.continued_after = static_cast<int>(options.start.eigenvalue.size());
  job.report.discarded = pieces.discarded();
  if (job.report.continued_after > 0)
    report(job.progress,
           "continues after " + std::to_string(job.report.continued_after) + " of " +
               std::to_string(options.n_modes) + " modes",
           1);
  return options;
}

void find_modes(Job& job, const fem::Matrices& matrices, ModePieces& pieces) {
  Plan& plan = job.plan;
  UniqueVec layout;
  check(MatCreateVecs(matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, plan.rows);
  const auto keep = [&](int k, Vec v) {
    Eigen::VectorXd phi = gather(v);
    job.on_root([&] {
      fix_sign(phi);
      Eigen::VectorXd column = mode_column(plan.body, phi, plan.moments, plan.S);
      if (job.options.store == Store::surface) phi.resize(0);
      pieces.add(k, {std::move(column), std::move(phi)});
    });
  };
  const Eigenmodes modes =
      find_eigenmodes(matrices.K, matrices.M, eigen_options(job, pieces, matrices), keep, job.progress);
  set_modal_matrices(plan.body, modes.eigenvalue);
  job.report.frequency = plan.body.frequency;
  job.report.residual = modes.residual;
  job.report.orthogonality = modes.orthogonality;
  job.finish_stage("eigenmodes");
}

io::BodySource source_of(const Job& job) {
  return {job.mesh, job.options.regions, job.options.element, job.plan.free_dof};
}

// Rank 0.
void write_modal(Job& job, const ModePieces& pieces) {
  model::ElasticBody& body = job.plan.body;
  const int n_q = static_cast<int>(body.frequency.size());
  const bool full = job.options.store == Store::all;
  allocate_modes(body, n_q);
  io::BodyWriter writer(job.output, job.mesh.n_nodes(), full ? n_q : 0, job.options.precision);
  pieces.visit([&](int k, const ModeRecord& mode) {
    if (k >= n_q) return;  // void
    set_mode(body, k, mode.column);
    if (full) writer.write_mode(k, mode.phi);
  });
  model::validate(body, job.output);
  writer.finish(body, source_of(job), {job.report.residual, job.report.orthogonality});
}

void reduce_modal(Job& job, const fem::Matrices& matrices) {
  ModePieces pieces(job.comm, job.output + ".partial", fingerprint_of(job, matrices), job.options.precision);
  find_modes(job, matrices, pieces);
  job.on_root([&] { write_modal(job, pieces); });
  pieces.clear();
}

void keep_all(Job& job, const fem::Matrices& matrices) {
  Plan& plan = job.plan;
  auto K = fem::gather_matrix(matrices.K, plan.rows), M = fem::gather_matrix(matrices.M, plan.rows);
  job.on_root([&] {
    set_full_basis(plan.body, plan.free_dof, plan.moments, plan.S);
    plan.body.K_r = std::move(K);
    plan.body.M_r = std::move(M);
  });
  job.finish_stage("gathering");
  job.on_root([&] {
    model::validate(plan.body, job.output);
    io::BodyWriter(job.output, job.mesh.n_nodes(), 0).finish(plan.body, source_of(job));
  });
}

void fill_report(Job& job) {
  const model::Inertia& inertia = job.plan.body.inertia;
  const Eigen::Vector3d c = inertia.c;
  ReductionReport& report = job.report;
  report.m = inertia.m;
  report.c = c;
  report.J = inertia.J - inertia.m * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  report.n_nodes = job.mesh.n_nodes();
  report.n_cells = job.mesh.cells.size();
  report.n_dofs = 3 * report.n_nodes;
  report.n_free = static_cast<int>(job.plan.free_dof.size());
  report.n_ranks = job.size;
  report.edge_cut = job.plan.partition.edge_cut;
  std::vector<int> cells(static_cast<std::size_t>(job.size), 0);
  for (int part : job.plan.partition.part) ++cells[part];
  report.balance =
      *std::max_element(cells.begin(), cells.end()) * static_cast<double>(job.size) / report.n_cells;
}

}  // namespace

ReductionReport reduce(MPI_Comm comm, const mesh::Mesh& mesh, const ReductionOptions& options,
                       const std::string& output, const Progress& progress) {
  Job job{comm, mesh, options, output, progress};
  MPI_Comm_rank(comm, &job.rank);
  MPI_Comm_size(comm, &job.size);
  job.on_root([&] { number(job); });
  const fem::Share share = fem::distribute(comm, mesh, job.plan.region, job.plan.rows);
  job.finish_stage("partition");
  job.on_root([&] { prepare_body(job); });
  job.finish_stage("inertia, surface and stress operator");
  const fem::Matrices matrices = fem::assemble(comm, share, options.regions, options.element, progress);
  job.finish_stage("assembly");
  if (job.modal())
    reduce_modal(job, matrices);
  else
    keep_all(job, matrices);
  job.on_root([&] { fill_report(job); });
  job.finish_stage("writing");
  return job.report;
}

}  // namespace elastogear::reduction
