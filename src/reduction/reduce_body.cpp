#include <algorithm>
#include <set>
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/elimination.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stress.h"
#include "elastogear/mesh/named_nodes.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/marker.h"
#include "reduction/cyclic/body_repetition.h"
#include "reduction/job/reduce_job.h"
#include "reduction/job/surface.h"

namespace elastogear::reduction {
namespace {

constexpr double kRounding = 1e-9;  // m and -: of an axis in a report

model::Stress make_stress(const mesh::Mesh& mesh, const std::vector<std::string>& sets) {
  std::set<int> nodes;
  for (const std::string& name : sets) {
    const std::vector<int> members = mesh::named_nodes(mesh, name).node;
    nodes.insert(members.begin(), members.end());
  }
  model::Stress stress;
  stress.node.assign(nodes.begin(), nodes.end());
  stress.X = mesh.X(Eigen::all, stress.node);
  for (const std::string& name : sets) {
    auto& local = stress.sets[name];
    local.clear();
    for (int node : mesh::named_nodes(mesh, name).node)
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
  body.markers = make_markers(mesh, options.markers);
  body.assembled_K = !options.imported;
  body.assembled_M = !options.imported && options.point_mass.empty();
  body.provenance = options.provenance;
  return body;
}

void validate_ritz(const ReductionOptions& options) {
  require(options.basis == model::Basis::modal && !options.flexibility && !options.attachments,
          "a Ritz basis is neither the full basis nor has it static responses beside its vectors");
  require(!options.floating, "Ritz bases need a held body: name sets of nodes by the option restrain");
  const RitzKind kind = options.ritz->kind;
  require(kind != RitzKind::modal_attachment || !options.loaded.empty(),
          "basis modal_attachment needs the face sets whose nodes get static solutions: option loaded");
  require(!options.loaded.empty() || !options.surface.empty(),
          "the basis needs loaded faces: name them by the option loaded, or a contact surface by surface");
  if (kind != RitzKind::krylov) return;
  require(!options.ritz->shift.empty(), "basis krylov needs a shift, in Hz");
  for (double shift : options.ritz->shift)
    require(std::isfinite(shift) && shift >= 0, "krylov shift ", shift,
            " Hz, must be finite and not negative");
}

void validate_mass(const ReductionOptions& options) {
  if (options.element_mass == model::ElementMass::compatible) return;
  if (options.imported)
    fail("element_mass condensed is of the mesh's own cells: the mass comes from ", options.imported->mass,
         ", leave one of the options element_mass and mass out");
  require(
      options.element == model::Element::incompatible,
      "element_mass condensed belongs to incompatible modes: take -element incompatible, or -element_mass "
      "compatible");
}

void validate(const ReductionOptions& options) {
  if (options.ritz) validate_ritz(options);
  if (!options.imported || !options.regions.empty()) fem::validate(options.regions);
  validate_relaxing(options);
  validate_mass(options);
  require(!options.floating || options.restrain.empty(), "a free body has no restrained sets");
  require(options.frame_origin.allFinite(), "the origin of the body frame (",
          options.frame_origin.transpose(), ") m must be finite");
  require(options.alpha >= 0, "damping alpha = ", options.alpha, " 1/s, must not be negative");
  require(options.beta >= 0, "damping beta = ", options.beta, " s, must not be negative");
  model::validate(options.ratio);
  require(options.ratio.ratio.empty() || options.basis == model::Basis::modal,
          "damping ratios belong to modes: the full basis takes Rayleigh's alpha and beta only");
  require(!options.flexibility || options.basis == model::Basis::modal,
          "static responses to contact forces belong to the modal basis");
  require(!options.attachments || options.basis == model::Basis::modal,
          "static responses to loads at markers belong to the modal basis");
  require(
      !options.flexibility || !options.surface.empty(),
      "static responses to contact forces need a contact surface: name its face sets by the option surface");
  for (const auto& [set, mass] : options.point_mass)
    require(std::isfinite(mass) && mass > 0, "point mass ", mass, " kg on '", set,
            "' must be finite and positive");
}

// The vector rounded, so that zeros have no roundoff.
Eigen::RowVector3d rounded(const Eigen::Vector3d& v) {
  return (v / kRounding).array().round() * kRounding + 0.0;
}

std::string describe(const mesh::Turn& turn) {
  std::ostringstream text;
  text << turn.n_sectors << " sectors around the direction (" << rounded(turn.axis) << ") through ("
       << rounded(turn.point) << ") m";
  return text.str();
}

// Finds the symmetry on rank 0; all ranks learn whether there is one.
void find_symmetry(Job& job) {
  mesh::Repetition& repetition = job.plan.repetition;
  const ReductionOptions& options = job.options;
  if (!job.modal() || options.ritz || options.symmetry == Symmetry::none) return;
  if (options.floating && !options.flexibility) return;
  if (!options.point_mass.empty()) {
    if (job.rank == 0) job.report.symmetry = "none: point masses";
    return;
  }
  job.on_root([&] {
    if (mesh::has_single_directions(job.plan.held)) {
      job.report.symmetry = "none: nodes are held in single directions";
      return;
    }
    auto [found, reason] = find_body_repetition(job.mesh, job.regions, {job.plan.region, job.plan.is_free});
    if (found) repetition = std::move(*found);
    job.report.symmetry = found ? describe(repetition.turn) : "none: " + reason;
    if (found && options.floating) job.report.symmetry += ", for static responses";
  });
  MPI_Bcast(&repetition.turn.n_sectors, 1, MPI_INT, 0, job.comm);
}

void number_on_root(Job& job) {
  const mesh::Mesh& mesh = job.mesh;
  Plan& plan = job.plan;
  validate(job.options);
  fem::require_positive_jacobians(mesh);
  plan.region = fem::cell_regions(mesh, job.regions);
  plan.held = fem::held_directions(mesh, job.options.restrain);
  plan.is_free = fem::free_nodes(plan.held);
  if (job.options.floating)
    fem::require_connected(mesh);
  else
    fem::require_held(mesh, plan.held);
  plan.free_dof = fem::free_dofs(plan.held);
  require(!plan.free_dof.empty(), "all nodes are restrained, no degree of freedom is left");
  if (job.modal() && !job.options.interval && !without_modes(job.options))
    require_mode_count(job.options.n_modes, static_cast<int>(plan.free_dof.size()));
}

// Throws Error when options and the displacements of the files together do not make a held or a free body.
void require_restraint(const Job& job, bool complete) {
  const ReductionOptions& options = job.options;
  const bool held = !complete || !options.restrain.empty();
  require(held || options.floating,
          "nothing holds the body: name sets of nodes by option restrain, or reduce it ",
          "as a free body (restrain: none)");
  require(!held || !options.floating, "a free body needs matrices of all displacements, ",
          options.imported->stiffness, " lacks some: they are held");
  require(complete || job.mesh.cells.size() > 0, options.imported->mass,
          " lacks displacements, so that the inertia must come from a mesh with cells and materials");
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
  fem::move_origin(moments, origin);
  job.report.origin = origin;
}

// Moves the materials into the body frame on all ranks but the first, which has done so.
void place_materials(Job& job) {
  MPI_Bcast(job.report.origin.data(), 3, MPI_DOUBLE, 0, job.comm);
  if (job.rank != 0) move_materials(job, job.report.origin);
}

// Nodes that hang on nothing would seem to rest.
void require_on_body(const Job& job) {
  if (job.options.imported) return;
  const std::vector<bool> in_cell = fem::free_nodes(job.mesh, {});
  std::vector<std::string> sets = job.options.markers;
  for (const auto& [set, mass] : job.options.point_mass) sets.push_back(set);
  for (const std::string& set : sets)
    for (int node : mesh::named_nodes(job.mesh, set).node)
      require(in_cell[node], "set '", set, "' of a marker or point mass: ", mesh::node_text(job.mesh, node),
              " belongs to no cell");
}

// How stresses are recovered, with all nodes on which simulations may let forces act.
model::StressRecovery make_recovery(const Job& job) {
  const ReductionOptions& options = job.options;
  model::StressRecovery recovery{recovery_method(options), job.plan.body.surface.node};
  if (recovery.method == model::RecoveryMethod::average) return {};
  std::vector<std::string> sets = options.markers;
  sets.insert(sets.end(), options.loaded.begin(), options.loaded.end());
  for (const auto& [set, mass] : options.point_mass) sets.push_back(set);
  for (const std::string& set : sets) {
    const std::vector<int> nodes = mesh::named_nodes(job.mesh, set).node;
    recovery.loaded.insert(recovery.loaded.end(), nodes.begin(), nodes.end());
  }
  sort_unique(recovery.loaded);
  return recovery;
}

model::SparseRows field_operator(const Job& job) {
  const mesh::Mesh& mesh = job.mesh;
  const model::Stress& stress = job.plan.body.stress;
  const model::SparseRows Q = marker_operator(mesh, job.options.markers);
  if (stress.node.empty()) return Q;
  const model::SparseRows S = fem::stress_operator(stressed_body(job), stress.node);
  model::SparseRows both(S.rows() + Q.rows(), S.cols());
  both.topRows(S.rows()) = S;
  both.bottomRows(Q.rows()) = Q;
  return both;
}

void prepare_on_root(Job& job) {
  require_on_body(job);
  Plan& plan = job.plan;
  if (plan.moments.w_0.size() == 0) plan.moments = fem::mass_moments(job.mesh, job.regions, formulation(job));
  for (const auto& [node, mass] : point_masses(job)) {
    plan.moments.w_0[node] += mass;
    plan.moments.w_1.col(node) += mass * job.mesh.X.col(node);
  }
  place_frame(job);
  plan.body = make_body(job.mesh, job.options, plan.moments);
  plan.recovery = make_recovery(job);
  plan.S = field_operator(job);
  place_of_output(job.output);  // an Error where nothing can be written
}

}  // namespace

bool without_modes(const ReductionOptions& o) { return o.n_modes == 0 && !o.interval && o.flexibility; }

void number(Job& job) {
  job.on_root([&] { number_on_root(job); });
  find_symmetry(job);
}

fem::StressedBody stressed_body(const Job& job) {
  return {job.mesh, job.regions, job.options.element, job.plan.recovery,
          fem::held_directions(job.plan.free_dof, job.mesh.n_nodes())};
}

std::map<int, double> point_masses(const Job& job) {
  std::map<int, double> masses;
  for (const auto& [set, mass] : job.options.point_mass) {
    const std::vector<int> nodes = mesh::named_nodes(job.mesh, set).node;
    require(!nodes.empty(), "point mass on '", set, "': the set is empty");
    for (int node : nodes) masses[node] += mass / static_cast<double>(nodes.size());
  }
  return masses;
}

fem::FieldMass field_mass(const Job& job) {
  fem::FieldMass all = job.options.imported ? fem::FieldMass{job.plan.imported_mass}
                                            : fem::field_mass(job.mesh, job.regions, formulation(job));
  for (const auto& [node, mass] : point_masses(job)) all.M_s.coeffRef(node, node) += mass;
  return all;
}

model::Formulation formulation(const Job& job) { return {job.options.element, job.options.element_mass}; }

void read_matrices(Job& job) {
  Plan& plan = job.plan;
  const ImportedFiles& files = *job.options.imported;
  job.on_root([&] { validate(job.options); });
  ImportedSystem system = read_imported(job.comm, job.mesh, files, job.progress);
  require_positive(system.matrices.M, files.mass);
  int complete = job.rank == 0 && is_complete(job.mesh, system.dof);
  MPI_Bcast(&complete, 1, MPI_INT, 0, job.comm);
  job.on_root([&] { require_restraint(job, complete); });
  if (complete) {
    UniqueVec layout;
    check(MatCreateVecs(system.matrices.M, layout.out(), nullptr));
    plan.moments = mass_moments(system.matrices.M, {layout, system.dof, 3 * job.mesh.n_nodes()}, job.mesh);
  }
  if (job.options.invariants == Invariants::full)
    plan.imported_mass = scalar_mass(system, job.mesh.n_nodes());
  job.on_root([&] { plan.held = mesh::held_by(job.mesh, job.options.restrain); });
  int restrains = job.rank == 0 && !job.options.restrain.empty();
  MPI_Bcast(&restrains, 1, MPI_INT, 0, job.comm);
  if (restrains) fem::eliminate(plan.held, system.matrices, system.dof);
  if (!job.options.floating) require_positive(system.matrices.K, files.stiffness);
  plan.dof = plan.free_dof = system.dof;
  plan.imported = std::move(system.matrices);
}

void prepare_body(Job& job) {
  job.on_root([&] { prepare_on_root(job); });
  place_materials(job);
}

}  // namespace elastogear::reduction
