#include "elastogear/reduction/reduce.h"

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

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
#include "elastogear/reduction/cyclic.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/surface.h"

namespace elastogear::reduction {
namespace {

constexpr double kRounding = 1e-9;  // m and -: of an axis in a report

// What rank 0 alone knows: the numbering, and everything of the body that needs no solution.
struct Plan {
  std::vector<int> region;    // of each cell
  std::vector<bool> is_free;  // of each node
  std::vector<int> free_dof;
  mesh::Repetition repetition;  // n_sectors = 1 (on all ranks): none
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
  bool cyclic() const { return plan.repetition.turn.n_sectors > 1; }

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

// Without the roundoff of zeros.
Eigen::RowVector3d rounded(const Eigen::Vector3d& v) {
  return (v / kRounding).array().round() * kRounding + 0.0;
}

std::string describe(const mesh::Turn& turn) {
  std::ostringstream text;
  text << turn.n_sectors << " sectors around the direction (" << rounded(turn.axis) << ") through ("
       << rounded(turn.point) << ") m";
  return text.str();
}

// On rank 0; whether there is one is known to all.
void find_symmetry(Job& job) {
  mesh::Repetition& repetition = job.plan.repetition;
  if (!job.modal() || job.options.symmetry == Symmetry::none) return;
  job.on_root([&] {
    auto [found, reason] = mesh::find_repetition(job.mesh, {job.plan.region, job.plan.is_free});
    if (found) repetition = std::move(*found);
    job.report.symmetry = found ? describe(repetition.turn) : "none: " + reason;
  });
  MPI_Bcast(&repetition.turn.n_sectors, 1, MPI_INT, 0, job.comm);
}

void number(Job& job) {
  const mesh::Mesh& mesh = job.mesh;
  Plan& plan = job.plan;
  validate(job.options);
  fem::require_positive_jacobians(mesh);
  plan.region = fem::cell_regions(mesh, job.options.regions);
  plan.is_free = fem::free_nodes(mesh, job.options.restrain);
  fem::require_held(mesh, plan.is_free);
  plan.free_dof = fem::free_dofs(plan.is_free);
  require(!plan.free_dof.empty(), "all nodes are restrained, no degree of freedom is left");
  if (job.modal()) require_mode_count(job.options.n_modes, static_cast<int>(plan.free_dof.size()));
}

fem::Matrices assemble(Job& job) {
  Plan& plan = job.plan;
  job.on_root([&] {
    plan.partition = mesh::partition_cells(job.mesh, job.size);
    plan.rows = fem::number_rows(job.mesh, plan.is_free, plan.partition.part, job.size);
  });
  const fem::Share share = fem::distribute(job.comm, job.mesh, plan.region, plan.rows);
  job.finish_stage("partition");
  fem::Matrices matrices =
      fem::assemble(job.comm, share, job.options.regions, job.options.element, job.progress);
  job.finish_stage("assembly");
  return matrices;
}

void prepare_body(Job& job, const std::string& output) {
  Plan& plan = job.plan;
  plan.moments = fem::mass_moments(job.mesh, job.options.regions);
  plan.body = make_body(job.mesh, job.options, plan.moments);
  plan.S = fem::stress_operator(job.mesh, job.options.regions, job.options.element, plan.body.stress.node);
  if (job.modal()) allocate_modes(plan.body, job.options.n_modes);
  plan.writer.emplace(output, job.mesh.n_nodes(), job.modal() ? job.options.n_modes : 0);
}

// Enters one mode into the body and the file, on rank 0. phi: all displacements there.
void keep_mode(Job& job, int k, Eigen::VectorXd phi) {
  job.on_root([&] {
    fix_sign(phi);
    add_mode(job.plan.body, k, phi, job.plan.moments, job.plan.S);
    job.plan.writer->write_mode(k, phi);
  });
}

EigenOptions eigen_options(const ReductionOptions& o) {
  EigenOptions options;
  options.n_modes = o.n_modes;
  options.window = o.window;
  options.prefix = o.prefix;
  return options;
}

Eigenmodes find_modes(Job& job) {
  const fem::Matrices matrices = assemble(job);
  UniqueVec layout;
  check(MatCreateVecs(matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, job.plan.rows);
  const auto keep = [&](int k, Vec v) { keep_mode(job, k, gather(v)); };
  return find_eigenmodes(matrices.K, matrices.M, eigen_options(job.options), keep, job.progress);
}

Eigenmodes find_modes_of_sectors(Job& job) {
  const Plan& plan = job.plan;
  const fem::MeshedBody body{job.mesh, job.options.regions, plan.region, plan.is_free, job.options.element};
  const auto keep = [&](int k, const Eigen::VectorXd& phi) { keep_mode(job, k, phi); };
  return find_cyclic_eigenmodes(job.comm, {body, plan.repetition}, {.eigen = eigen_options(job.options)},
                                keep, job.progress);
}

void reduce_modal(Job& job) {
  const Eigenmodes modes = job.cyclic() ? find_modes_of_sectors(job) : find_modes(job);
  set_modal_matrices(job.plan.body, modes.eigenvalue);
  job.report.frequency = job.plan.body.frequency;
  job.report.residual = modes.residual;
  job.finish_stage("eigenmodes");
}

void keep_all(Job& job) {
  Plan& plan = job.plan;
  const fem::Matrices matrices = assemble(job);
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
  if (!job.cyclic())
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
  find_symmetry(job);
  job.finish_stage("numbering and symmetry");
  job.on_root([&] { prepare_body(job, output); });
  job.finish_stage("inertia, surface and stress operator");
  if (job.modal())
    reduce_modal(job);
  else
    keep_all(job);
  job.on_root([&] {
    model::validate(job.plan.body, output);
    job.plan.writer->finish(job.plan.body, {mesh, options.regions, options.element, job.plan.free_dof});
    fill_report(job);
  });
  job.finish_stage("writing");
  return job.report;
}

}  // namespace elastogear::reduction
