#include <algorithm>

#include "elastogear/io/body_file.h"
#include "elastogear/io/body_materials.h"
#include "elastogear/model/validate_rows.h"
#include "io/body/basis_rows.h"
#include "io/body/body_schema.h"
#include "io/body/flexibility_group.h"
#include "io/body/relaxing_group.h"
#include "io/body/row_bounds_group.h"
#include "io/hdf5/checks.h"

namespace elastogear::io {
namespace {

using model::Basis;

Eigen::Matrix<double, Eigen::Dynamic, 3> read_coupling(const h5::File& file, const std::string& name,
                                                       Eigen::Index n_q) {
  const auto values = h5::read<double>(file, name, {extent(n_q), 3});
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(values.data(), n_q, 3);
}

model::Inertia read_inertia(const h5::File& file, Eigen::Index n_q) {
  model::Inertia inertia;
  inertia.m = h5::read<double>(file, "/rigid/mass", {}).front();
  inertia.c = Eigen::Map<const Eigen::Vector3d>(h5::read<double>(file, "/rigid/center", {3}).data());
  inertia.J = Eigen::Map<const Eigen::Matrix3d>(h5::read<double>(file, "/rigid/inertia", {3, 3}).data());
  inertia.C_l = read_coupling(file, "/reduced/C_l", n_q);
  inertia.C_r = read_coupling(file, "/reduced/C_r", n_q);
  const auto S_1 = h5::read<double>(file, "/reduced/S_1", {extent(n_q), 3, 3});
  inertia.S_1 = Eigen::Map<const Eigen::Matrix<double, 9, Eigen::Dynamic>>(S_1.data(), 9, n_q);
  if (h5::exists(file, "/reduced/S_2"))
    for (const char* moment : kMoments)
      inertia.S_2.push_back(read_matrix(file, std::string("/reduced/S_2/") + moment));
  return inertia;
}

// Numbers of nodes of the mesh.
std::vector<int> read_nodes(const h5::File& file, const std::string& name) {
  auto nodes = h5::read<int>(file, name, {h5::kAny});
  const auto n = static_cast<int>(h5::shape(file, "/mesh/X").at(0));
  const auto beyond = std::find_if(nodes.begin(), nodes.end(), [n](int i) { return i < 0 || i >= n; });
  if (beyond != nodes.end()) fail(file.path, ": ", name, " holds ", *beyond, ", must be within 0..", n - 1);
  return nodes;
}

model::Surface read_surface(const h5::File& file) {
  model::Surface surface;
  surface.node = read_nodes(file, "/surface/nodes");
  surface.X = read_points(file, "/surface/X");
  const auto face = h5::read<int>(file, "/surface/face", {h5::kAny, 4});
  surface.face =
      Eigen::Map<const Eigen::Matrix4Xi>(face.data(), 4, static_cast<Eigen::Index>(face.size() / 4));
  if (h5::exists(file, "/surface/side")) {
    const auto side = h5::read<int>(file, "/surface/side", {h5::kAny, 8});
    surface.side = Eigen::Map<const Eigen::Matrix<int, 8, Eigen::Dynamic>>(
        side.data(), 8, static_cast<Eigen::Index>(side.size() / 8));
  }
  surface.group = h5::read<int>(file, "/surface/group", {h5::kAny});
  surface.group_name = h5::read_strings(file, "/surface/group_name");
  surface.c_f = read_vector(file, "/surface/c_f");
  return surface;
}

model::Stress read_stress(const h5::File& file) {
  model::Stress stress;
  stress.node = read_nodes(file, "/stress/nodes");
  stress.X = read_points(file, "/stress/X");
  stress.Psi = read_rows(file, "/stress/Psi", 6);
  for (const std::string& name : h5::members(file, "/stress/sets"))
    stress.sets[name] = h5::read<int>(file, "/stress/sets/" + name, {h5::kAny});
  return stress;
}

// The number of attachment modes. Files of earlier versions hold the static responses of the surface, not
// those of markers.
int read_attachments(const h5::File& file) {
  if (h5::has_attribute(file, "/modes", kAttachments))
    return h5::int_attribute(file, "/modes", kAttachments).front();
  const bool lacks = h5::exists(file, "/flexibility") && !h5::members(file, "/markers").empty();
  require(!lacks, file.path,
          ": has no static responses to loads at its markers, as files of earlier versions: reduce the body "
          "again");
  return 0;
}

Eigen::Vector3d read_three(const h5::File& file, const std::string& name) {
  const auto x = h5::read<double>(file, name, {3});
  return Eigen::Map<const Eigen::Vector3d>(x.data());
}

std::vector<model::Marker> read_markers(const h5::File& file) {
  std::vector<model::Marker> markers;
  if (!h5::exists(file, "/markers")) return markers;
  for (const std::string& name : h5::members(file, "/markers")) {
    const std::string group = "/markers/" + name;
    markers.push_back({name, read_three(file, group + "/X"),
                       h5::int_attribute(file, group, "turns").front() != 0,
                       read_rows(file, group + "/Phi", 6)});
    if (h5::exists(file, group + "/area"))
      markers.back().area = {read_three(file, group + "/area"), read_three(file, group + "/area_moment")};
  }
  return markers;
}

model::Material read_material(const h5::File& file, const std::string& group) {
  const auto number = [&](const char* name) { return h5::read<double>(file, group + name, {}).front(); };
  const auto vector = [&](const char* name) -> Eigen::Vector3d {
    return Eigen::Map<const Eigen::Vector3d>(h5::read<double>(file, group + name, {3}).data());
  };
  const auto viscoelastic = read_viscoelastic(file, group);
  if (!h5::exists(file, group + "/G")) return {number("/E"), number("/nu"), number("/rho"), {}, viscoelastic};
  model::Orthotropic m{vector("/E"), vector("/nu"), vector("/G"), {}};
  m.orientation.system = parse_system(file.path, h5::string_attribute(file, group, "orientation"));
  m.orientation.axis_1 = vector("/axis_1");
  m.orientation.axis_2 = vector("/axis_2");
  m.orientation.origin = vector("/origin");
  m.orientation.axis = vector("/axis");
  m.orientation.rotation = vector("/rotation");
  return {0, 0, number("/rho"), m, viscoelastic};
}

std::vector<model::MaterialRegion> read_materials(const h5::File& file) {
  std::vector<model::MaterialRegion> regions;
  for (std::size_t i = 0; h5::exists(file, "/material/" + std::to_string(i)); ++i) {
    const std::string group = "/material/" + std::to_string(i);
    regions.push_back({h5::string_attribute(file, group, "cell_set"), read_material(file, group)});
  }
  return regions;
}

std::vector<int> read_free_dof(const h5::File& file, Eigen::Index n_dof) {
  auto dof = h5::read<int>(file, "/reduced/free_dof", {h5::kAny});
  require(ascends_below(dof, n_dof), file.path, ": /reduced/free_dof must ascend within 0..", n_dof - 1);
  return dof;
}

model::StressRecovery read_recovery(const h5::File& file, Eigen::Index n_nodes) {
  if (!h5::exists(file, kLoadedNodes)) return {};
  auto loaded = h5::read<int>(file, kLoadedNodes, {h5::kAny});
  require(ascends_below(loaded, n_nodes), file.path, ": ", kLoadedNodes, " must ascend within 0..",
          n_nodes - 1);
  return {model::RecoveryMethod::surface, std::move(loaded)};
}

Basis read_basis(const h5::File& file) {
  return parse_basis(file.path, h5::string_attribute(file, "/", "basis"));
}

using VisitMode = std::function<void(Eigen::Index k, const Eigen::VectorXd& phi)>;

// Visits n_q modes; one mode in memory at a time.
void visit_all_modes(const h5::File& file, Eigen::Index n_q, const VisitMode& visit) {
  require(h5::exists(file, "/modes/Phi"), file.path,
          ": holds the modes at surface and stress nodes only; reduce the body with -store all to recover "
          "whole fields");
  const h5::Shape shape = h5::shape(file, "/modes/Phi");
  require(shape.size() == 3 && shape[0] == extent(n_q) && shape[2] == 3, file.path,
          ": /modes/Phi does not hold ", n_q, " modes of n nodes x 3");
  Eigen::VectorXd phi(static_cast<Eigen::Index>(3 * shape[1]));
  for (hsize_t k = 0; k < shape[0]; ++k) {
    h5::read_rows(file, "/modes/Phi", {k, {1, shape[1], 3}}, phi.data());
    visit(static_cast<Eigen::Index>(k), phi);
  }
}

}  // namespace

model::ElasticBody read_body(const std::string& path, BodyUse use) {
  const h5::File file = open_format(path, kBodyFormat);
  model::ElasticBody body;
  body.name = h5::string_attribute(file, "/", "name");
  body.basis = read_basis(file);
  body.floating = h5::string_attribute(file, "/", "restraint") == "none";
  body.provenance = h5::read_map(file, "/provenance");
  body.M_r = read_square(file, "/reduced/M");
  body.K_r = read_square(file, "/reduced/K");
  body.assembled_K = h5::has_attribute(file, "/", kAssembledK) && read_flag(file, "/", kAssembledK);
  body.assembled_M = h5::has_attribute(file, "/", kAssembledM) && read_flag(file, "/", kAssembledM);
  body.alpha = h5::number_attribute(file, "/reduced", "alpha");
  body.beta = h5::number_attribute(file, "/reduced", "beta");
  if (body.basis == Basis::modal) {
    body.frequency = read_vector(file, "/modes/frequency", extent(body.n_q()));
    body.n_attachments = read_attachments(file);
  }
  if (h5::exists(file, "/modes/damping_ratio")) body.zeta = read_vector(file, "/modes/damping_ratio");
  body.inertia = read_inertia(file, body.n_q());
  body.surface = read_surface(file);
  if (use == BodyUse::motion && has_row_bounds(file))
    body.surface.Phi = lazy_rows(file, body);
  else
    body.surface.Phi = read_rows(file, "/surface/Phi", 3);
  if (use == BodyUse::all) body.stress = read_stress(file);
  body.markers = read_markers(file);
  body.flexibility = read_flexibility(file);
  body.relaxing = read_relaxing(file, use == BodyUse::all);
  model::validate_except_rows(body, path);  // reading has tested them
  return body;
}

std::vector<std::string> read_stress_set_names(const std::string& path) {
  return h5::members(open_format(path, kBodyFormat), "/stress/sets");
}

BodySource read_body_source(const std::string& path) {
  const h5::File file = open_format(path, kBodyFormat);
  BodySource source;
  source.mesh = read_mesh(file);
  source.regions = read_materials(file);
  source.element = parse_element(path, h5::string_attribute(file, "/", "element"));
  if (h5::has_attribute(file, "/", kElementMass))
    source.element_mass = parse_element_mass(path, h5::string_attribute(file, "/", kElementMass));
  source.free_dof = read_free_dof(file, 3 * source.mesh.X.cols());
  source.origin = Eigen::Map<const Eigen::Vector3d>(h5::read<double>(file, "/rigid/origin", {3}).data());
  source.checks = read_checks(file);
  source.recovery = read_recovery(file, source.mesh.X.cols());
  return source;
}

BodyMaterials read_body_materials(const std::string& path) {
  const h5::File file = open_format(path, kBodyFormat);
  const h5::Shape cells = h5::shape(file, "/mesh/cell_type");
  return {read_materials(file), cells.size() == 1 && cells[0] > 0};
}

ModeChecks read_mode_checks(const std::string& path) {
  const h5::File file = open_format(path, kBodyFormat);
  if (!h5::exists(file, "/checks/residual")) return {};
  return {read_vector(file, "/checks/residual"), h5::read<double>(file, "/checks/orthogonality", {}).front()};
}

bool has_full_modes(const std::string& path) {
  return h5::exists(open_format(path, kBodyFormat), "/modes/Phi");
}

Eigen::MatrixXd read_displacement_fields(const std::string& path, const Eigen::MatrixXd& Q) {
  const h5::File file = open_format(path, kBodyFormat);
  require(Q.allFinite(), path, ": elastic coordinates are not finite");
  Eigen::MatrixXd U;
  if (read_basis(file) == Basis::modal) {
    visit_all_modes(file, Q.rows(), [&](Eigen::Index k, const Eigen::VectorXd& phi) {
      if (k == 0) U.setZero(phi.size(), Q.cols());
      U += phi * Q.row(k);
    });
    return U;
  }
  const auto n_nodes = static_cast<Eigen::Index>(h5::shape(file, "/mesh/X").at(0));
  const std::vector<int> dof = read_free_dof(file, 3 * n_nodes);
  require(static_cast<Eigen::Index>(dof.size()) == Q.rows(), path, ": has ", dof.size(), " coordinates, not ",
          Q.rows());
  U.setZero(3 * n_nodes, Q.cols());
  U(dof, Eigen::all) = Q;
  return U;
}

Eigen::Matrix3Xd read_displacement_field(const std::string& path, const Eigen::VectorXd& q) {
  const Eigen::MatrixXd u = read_displacement_fields(path, q);
  return u.reshaped(3, u.rows() / 3);
}

void visit_modes(const std::string& path, Eigen::Index n_q, const VisitMode& visit) {
  const h5::File file = open_format(path, kBodyFormat);
  require(read_basis(file) == Basis::modal, path, ": has the full basis, no modes");
  visit_all_modes(file, n_q, visit);
}

}  // namespace elastogear::io
