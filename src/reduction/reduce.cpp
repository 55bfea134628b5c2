#include "elastogear/reduction/reduce.h"

#include <algorithm>
#include <optional>
#include <set>

#include "elastogear/base/agree.h"
#include "elastogear/base/error.h"
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
  std::optional<io::BodyWriter> writer;
};

struct Job {
  MPI_Comm comm;
  const mesh::Mesh& mesh;
  const ReductionOptions& options;
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

void prepare_body(Job& job, const std::string& output) {
  Plan& plan = job.plan;
  plan.moments = fem::mass_moments(job.mesh, job.options.regions);
  plan.body = make_body(job.mesh, job.options, plan.moments);
  plan.S = fem::stress_operator(job.mesh, job.options.regions, job.options.element, plan.body.stress.node);
  if (job.modal()) allocate_modes(plan.body, job.options.n_modes);
  plan.writer.emplace(output, job.mesh.n_nodes(), job.modal() ? job.options.n_modes : 0);
}

void reduce_modal(Job& job, const fem::Matrices& matrices) {
  Plan& plan = job.plan;
  UniqueVec layout;
  check(MatCreateVecs(matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, plan.rows);
  const auto keep = [&](int k, Vec v) {
    Eigen::VectorXd phi = gather(v);
    job.on_root([&] {
      fix_sign(phi);
      add_mode(plan.body, k, phi, plan.moments, plan.S);
      plan.writer->write_mode(k, phi);
    });
  };
  EigenOptions options;
  options.n_modes = job.options.n_modes;
  options.window = job.options.window;
  options.prefix = job.options.prefix;
  const Eigenmodes modes = find_eigenmodes(matrices.K, matrices.M, options, keep, job.progress);
  set_modal_matrices(plan.body, modes.eigenvalue);
  job.report.frequency = plan.body.frequency;
  job.report.residual = modes.residual;
  job.finish_stage("eigenmodes");
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
  Job job{comm, mesh, options, progress};
  MPI_Comm_rank(comm, &job.rank);
  MPI_Comm_size(comm, &job.size);
  job.on_root([&] { number(job); });
  const fem::Share share = fem::distribute(comm, mesh, job.plan.region, job.plan.rows);
  job.finish_stage("partition");
  job.on_root([&] { prepare_body(job, output); });
  job.finish_stage("inertia, surface and stress operator");
  const fem::Matrices matrices = fem::assemble(comm, share, options.regions, options.element, progress);
  job.finish_stage("assembly");
  if (job.modal())
    reduce_modal(job, matrices);
  else
    keep_all(job, matrices);
  job.on_root([&] {
    model::validate(job.plan.body, output);
    job.plan.writer->finish(job.plan.body, {mesh, options.regions, options.element, job.plan.free_dof});
    fill_report(job);
  });
  job.finish_stage("writing");
  return job.report;
}

}  // namespace elastogear::reduction
