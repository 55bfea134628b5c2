#include "elastogear/reduction/reduce.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <sstream>

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
#include "elastogear/reduction/checks.h"
#include "elastogear/reduction/cyclic.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/free_body.h"
#include "elastogear/reduction/surface.h"
#include "fingerprint.h"
#include "harmonic_pieces.h"
#include "mode_pieces.h"

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
  fem::RowNumbering rows;  // own matrices only
  fem::Matrices foreign;   // on all ranks
  std::vector<int> dof;    // displacement of every scalar row
  fem::MassMoments moments;
  model::SparseRows S;
  model::ElasticBody body;
};

struct Job {
  MPI_Comm comm;
  mesh::Mesh mesh;
  const ReductionOptions& options;
  const std::string& output;
  const Progress& progress;
  int rank = 0, size = 1;
  Plan plan = {};
  ReductionReport report = {};
  std::vector<model::MaterialRegion> regions = options.regions;  // in the body frame, as the mesh is
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
  body.floating = options.floating;
  body.inertia = fem::rigid_inertia(mesh, moments);
  body.alpha = options.alpha;
  body.beta = options.beta;
  if (!options.surface.empty()) body.surface = make_surface(mesh, options.regions, options.surface);
  body.stress = make_stress(mesh, options.stress_nodes);
  body.provenance = options.provenance;
  return body;
}

void validate(const ReductionOptions& options) {
  if (!options.foreign || !options.regions.empty()) fem::validate(options.regions);
  require(!options.floating || options.restrain.empty(), "a free body has no restrained node sets");
  require(options.frame_origin.allFinite(), "the origin of the body frame (",
          options.frame_origin.transpose(), ") m must be finite");
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

// Whether the turn leaves the material's directions as they are.
bool repeats(const model::Material& material, const mesh::Turn& turn) {
  if (!material.orthotropic) return true;
  const model::Orientation& o = material.orthotropic->orientation;
  const Eigen::Vector3d axis = o.axis.normalized();
  return o.system == model::Orientation::System::cylindrical && axis.cross(turn.axis).norm() < kRounding &&
         axis.cross(o.origin - turn.point).norm() < kRounding;
}

// Of the mesh and of all materials; or why there is none.
mesh::RepetitionSearch search_repetition(const Job& job) {
  auto search = mesh::find_repetition(job.mesh, {job.plan.region, job.plan.is_free});
  if (!search.found) return search;
  for (const model::MaterialRegion& region : job.regions)
    if (!repeats(region.material, search.found->turn))
      return {{}, "the directions of an orthotropic material do not turn with the mesh"};
  return search;
}

// On rank 0; whether there is one is known to all.
void find_symmetry(Job& job) {
  mesh::Repetition& repetition = job.plan.repetition;
  if (!job.modal() || job.options.floating || job.options.symmetry == Symmetry::none) return;
  job.on_root([&] {
    auto [found, reason] = search_repetition(job);
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
  plan.region = fem::cell_regions(mesh, job.regions);
  plan.is_free = fem::free_nodes(mesh, job.options.restrain);
  if (job.options.floating)
    fem::require_connected(mesh);
  else
    fem::require_held(mesh, plan.is_free);
  plan.free_dof = fem::free_dofs(plan.is_free);
  require(!plan.free_dof.empty(), "all nodes are restrained, no degree of freedom is left");
  if (job.modal()) require_mode_count(job.options.n_modes, static_cast<int>(plan.free_dof.size()));
}

fem::Matrices assemble(Job& job) {
  Plan& plan = job.plan;
  if (job.options.foreign) return std::move(plan.foreign);
  job.on_root([&] {
    plan.partition = mesh::partition_cells(job.mesh, job.size);
    plan.rows = fem::number_rows(job.mesh, plan.is_free, plan.partition.part, job.size);
    plan.dof = fem::row_dofs(plan.rows);
  });
  const fem::Share share = fem::distribute(job.comm, job.mesh, plan.region, plan.rows);
  job.finish_stage("partition");
  fem::Matrices matrices = fem::assemble(job.comm, share, job.regions, job.options.element, job.progress);
  job.finish_stage("assembly");
  return matrices;
}

// What the user may still hold or not, given the displacements that the files have.
void require_restraint(const Job& job, bool complete) {
  const ReductionOptions& options = job.options;
  const bool held = !complete || !options.restrain.empty();
  require(held || options.floating,
          "nothing holds the body: name node sets by option restrain, or reduce it ",
          "as a free body (restrain: none)");
  require(!held || !options.floating, "a free body needs matrices of all displacements, ",
          options.foreign->stiffness, " lacks some: they are held");
  require(complete || job.mesh.cells.size() > 0, options.foreign->mass,
          " lacks displacements, so that the inertia must come from a mesh with cells and materials");
}

void read_matrices(Job& job) {
  Plan& plan = job.plan;
  const ForeignFiles& files = *job.options.foreign;
  job.on_root([&] { validate(job.options); });
  ForeignSystem system = read_foreign(job.comm, job.mesh, files, job.progress);
  require_positive(system.matrices.M, files.mass);
  int complete = job.rank == 0 && is_complete(job.mesh, system.dof);
  MPI_Bcast(&complete, 1, MPI_INT, 0, job.comm);
  job.on_root([&] { require_restraint(job, complete); });
  if (complete) {
    UniqueVec layout;
    check(MatCreateVecs(system.matrices.M, layout.out(), nullptr));
    plan.moments = mass_moments(system.matrices.M, {layout, system.dof, 3 * job.mesh.n_nodes()}, job.mesh);
  }
  job.on_root([&] {
    plan.is_free.assign(static_cast<std::size_t>(job.mesh.n_nodes()), true);
    for (const std::string& name : job.options.restrain)
      for (int node : mesh::node_set(job.mesh, name)) plan.is_free[node] = false;
  });
  if (!job.options.restrain.empty()) system = restrict_to(system, plan.is_free);
  if (!job.options.floating) require_positive(system.matrices.K, files.stiffness);
  plan.dof = plan.free_dof = system.dof;
  plan.foreign = std::move(system.matrices);
}

void move_materials(Job& job, const Eigen::Vector3d& origin) {
  for (model::MaterialRegion& region : job.regions)
    if (region.material.orthotropic) region.material.orthotropic->orientation.origin -= origin;
}

// From here on all coordinates are in the body frame.
void place_frame(Job& job) {
  fem::MassMoments& moments = job.plan.moments;
  const Eigen::Vector3d origin =
      job.options.frame_at_center ? fem::rigid_inertia(job.mesh, moments).c : job.options.frame_origin;
  job.mesh.X.colwise() -= origin;
  job.plan.repetition.turn.point -= origin;
  move_materials(job, origin);
  moments.w_1 -= origin * moments.w_0.transpose();
  job.report.origin = origin;
}

// On the other ranks.
void place_materials(Job& job) {
  MPI_Bcast(job.report.origin.data(), 3, MPI_DOUBLE, 0, job.comm);
  if (job.rank != 0) move_materials(job, job.report.origin);
}

void prepare_body(Job& job) {
  Plan& plan = job.plan;
  if (plan.moments.w_0.size() == 0) plan.moments = fem::mass_moments(job.mesh, job.regions);
  place_frame(job);
  plan.body = make_body(job.mesh, job.options, plan.moments);
  plan.S = plan.body.stress.node.empty()
               ? model::SparseRows(0, 3 * job.mesh.n_nodes())
               : fem::stress_operator(job.mesh, job.regions, job.options.element, plan.body.stress.node);
  const PendingFile can_be_written(job.output);
}

// What the modes depend on, but for what the way of finding them adds. Rank 0.
Fingerprint fingerprint_of(const Job& job) {
  const ReductionOptions& o = job.options;
  Fingerprint f;
  f.add(std::string(version()) + git_hash() + o.prefix);
  for (int option : {o.n_modes, o.window, static_cast<int>(o.store), static_cast<int>(o.precision)})
    f.add(static_cast<double>(option));
  f.add_all(job.plan.moments.w_0);
  f.add_all(job.plan.moments.w_1.reshaped());
  f.add_all(job.plan.body.surface.node);
  f.add_all(job.plan.body.stress.node);
  f.add_all(std::span(job.plan.S.valuePtr(), static_cast<std::size_t>(job.plan.S.nonZeros())));
  return f;
}

EigenOptions eigen_options(const ReductionOptions& o) {
  EigenOptions options;
  options.n_modes = o.n_modes;
  options.window = o.window;
  options.prefix = o.prefix;
  options.whole_pairs = true;
  return options;
}

void report_continued(Job& job, int pieces, int discarded, const std::string& what) {
  job.report.discarded = discarded;
  if (pieces == 0) return;
  job.report.continued_after = std::to_string(pieces) + " " + what;
  report(job.progress, "continues after " + job.report.continued_after, 1);
}

// The numbers that the body keeps of a mode, and its field where that is stored too. Rank 0.
ModeRecord mode_record(const Job& job, Eigen::VectorXd phi) {
  fix_sign(phi);
  Eigen::VectorXd column = mode_column(job.plan.body, phi, job.plan.moments, job.plan.S);
  if (job.options.store == Store::surface) phi.resize(0);
  return {std::move(column), std::move(phi)};
}

void set_eigenmodes(Job& job, const Eigenmodes& modes) {
  set_modal_matrices(job.plan.body, modes.eigenvalue);
  job.report.frequency = job.plan.body.frequency;
  job.report.residual = modes.residual;
  job.report.orthogonality = modes.orthogonality;
}

io::BodySource source_of(const Job& job) {
  return {job.mesh,          job.regions,       job.options.element,
          job.plan.free_dof, job.report.checks, job.report.origin};
}

// The body file of a modal basis, mode by mode. Rank 0.
class ModalWriter {
 public:
  ModalWriter(Job& job, int n_q)
      : job_(job),
        full_(job.options.store == Store::all),
        writer_(job.output, job.mesh.n_nodes(), full_ ? n_q : 0, job.options.precision) {
    allocate_modes(job.plan.body, n_q);
  }
  void add(int k, const ModeRecord& mode) {
    set_mode(job_.plan.body, k, mode.column);
    if (full_) writer_.write_mode(k, mode.phi);
  }
  void finish() {
    model::validate(job_.plan.body, job_.output);
    writer_.finish(job_.plan.body, source_of(job_), {job_.report.residual, job_.report.orthogonality});
  }

 private:
  Job& job_;
  bool full_;
  io::BodyWriter writer_;
};

Eigenmodes find_modes(Job& job, const ElasticSystem& system, ModePieces& pieces) {
  PetscInt n_own = 0;
  check(MatGetLocalSize(system.K, &n_own, nullptr));
  const auto keep = [&](int k, Vec v) {
    Eigen::VectorXd phi = system.gather(v);
    job.on_root([&] { pieces.add(k, mode_record(job, std::move(phi))); });
  };
  EigenOptions options = eigen_options(job.options);
  options.start = pieces.resume(static_cast<int>(n_own));
  options.commit = [&](const SearchState& state) { pieces.commit(state); };
  report_continued(job, static_cast<int>(options.start.eigenvalue.size()), pieces.discarded(),
                   "of " + std::to_string(options.n_modes) + " modes");
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

void check_basis(Job& job, const ElasticSystem& system) {
  const Plan& plan = job.plan;
  auto& checks = job.report.checks;
  checks = mass_checks(system, plan.body, plan.moments);
  if (job.options.completeness)
    for (model::Check& check : load_checks(system, plan.body, job.mesh.n_nodes()))
      checks.push_back(std::move(check));
  job.finish_stage("checks");
}

// From the matrices of the whole body.
void reduce_whole(Job& job) {
  const fem::Matrices matrices = assemble(job);
  UniqueVec layout;
  check(MatCreateVecs(matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, job.plan.dof, 3 * job.mesh.n_nodes());
  std::optional<RigidModes> rigid;
  if (job.options.floating) rigid = find_rigid_modes(matrices.K, matrices.M, gather, job.mesh.X);
  const ElasticSystem system{matrices.K, matrices.M, gather, rigid ? &*rigid : nullptr};
  ModePieces pieces(job.comm, job.output + ".partial", fingerprint_of(job, matrices), job.options.precision);
  set_eigenmodes(job, find_modes(job, system, pieces));
  job.finish_stage("eigenmodes");
  std::optional<ModalWriter> writer;
  job.on_root([&] {
    const int n_q = static_cast<int>(job.report.frequency.size());
    writer.emplace(job, n_q);
    pieces.visit([&](int k, const ModeRecord& mode) {
      if (k < n_q) writer->add(k, mode);  // later ones are void
    });
  });
  check_basis(job, system);
  job.on_root([&] { writer->finish(); });
  pieces.clear();
}

void add(Fingerprint& f, const model::Material& material) {
  for (double x : {material.E, material.nu, material.rho}) f.add(x);
  if (!material.orthotropic) return;
  const auto& [E, nu, G, o] = *material.orthotropic;
  f.add(static_cast<double>(o.system));
  for (const auto& v : {E, nu, G, o.axis_1, o.axis_2, o.origin, o.axis, o.rotation}) f.add_all(v);
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
  });
  return f.text();
}

// From one sector of a body that repeats.
void reduce_sectors(Job& job) {
  HarmonicPieces pieces(job.comm, job.output + ".partial", fingerprint_of_sectors(job));
  const Plan& plan = job.plan;
  const fem::MeshedBody body{job.mesh, job.regions, plan.region, plan.is_free, job.options.element};
  std::optional<ModalWriter> writer;
  CyclicOptions options;
  options.eigen = eigen_options(job.options);
  options.known = [&](int k, double cutoff) { return pieces.read(k, cutoff); };
  options.done = [&](const HarmonicModes& modes) { pieces.write(modes); };
  options.begin = [&](int n_q) { job.on_root([&] { writer.emplace(job, n_q); }); };
  report_continued(job, pieces.n_known(), pieces.discarded(), "harmonics");
  const auto keep = [&](int k, const Eigen::VectorXd& phi) {
    job.on_root([&] { writer->add(k, mode_record(job, phi)); });
  };
  set_eigenmodes(job, find_cyclic_eigenmodes(job.comm, {body, plan.repetition}, options, keep, job.progress));
  job.finish_stage("eigenmodes");
  job.on_root([&] { writer->finish(); });
  pieces.clear();
}

void reduce_modal(Job& job) { job.cyclic() ? reduce_sectors(job) : reduce_whole(job); }

void keep_all(Job& job) {
  Plan& plan = job.plan;
  const fem::Matrices matrices = assemble(job);
  auto K = fem::gather_matrix(matrices.K, plan.dof), M = fem::gather_matrix(matrices.M, plan.dof);
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
  if (job.options.foreign) return;
  std::vector<int> cells(static_cast<std::size_t>(job.size), 0);
  for (int part : job.plan.partition.part) ++cells[part];
  if (!job.cyclic())
    report.balance =
        *std::max_element(cells.begin(), cells.end()) * static_cast<double>(job.size) / report.n_cells;
}

}  // namespace

ReductionReport reduce(MPI_Comm comm, const mesh::Mesh& mesh, const ReductionOptions& options,
                       const std::string& output, const Progress& progress) {
  Job job{comm, mesh, options, output, progress};
  MPI_Comm_rank(comm, &job.rank);
  MPI_Comm_size(comm, &job.size);
  if (options.foreign) {
    read_matrices(job);
    job.finish_stage("reading matrices");
  } else {
    job.on_root([&] { number(job); });
    find_symmetry(job);
    job.finish_stage("numbering and symmetry");
  }
  job.on_root([&] { prepare_body(job); });
  place_materials(job);
  job.finish_stage("inertia, surface and stress operator");
  if (job.modal())
    reduce_modal(job);
  else
    keep_all(job);
  job.on_root([&] { fill_report(job); });
  job.finish_stage("writing");
  return job.report;
}

}  // namespace elastogear::reduction
