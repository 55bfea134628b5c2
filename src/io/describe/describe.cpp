#include "elastogear/io/describe.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include "elastogear/base/file.h"
#include "elastogear/base/text.h"
#include "elastogear/io/body_file.h"
#include "elastogear/mesh/file.h"
#include "elastogear/mesh/hold.h"
#include "elastogear/mesh/joints.h"
#include "elastogear/mesh/quality.h"
#include "io/body/body_schema.h"
#include "io/body/relaxing_group.h"
#include "io/describe/describe_arrays.h"
#include "io/describe/describe_result.h"
#include "io/describe/describe_text.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

const Eigen::IOFormat kRow(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", "; ");

template <class Set>
void describe_sets(Out& out, const char* kind, const std::map<std::string, Set>& sets) {
  if (sets.empty()) return;
  line(out, kind, " sets:");
  for (const auto& [name, members] : sets) line(out, "  ", name, ": ", members.size());
}

// "12 hex8, 4 wedge6"
std::string cell_types(const mesh::Cells& cells) {
  std::map<mesh::CellType, int> count;
  for (mesh::CellType type : cells.type) ++count[type];
  return join(count, ", ",
              [](const auto& of) { return std::to_string(of.second) + " " + mesh::name(of.first); });
}

void describe_mesh(Out& out, const mesh::Mesh& mesh) {
  line(out, "mesh: ", counted(mesh.n_nodes(), "node"), ", ", counted(mesh.cells.size(), "cell"), " (",
       cell_types(mesh.cells), ")");
  if (mesh.n_nodes() > 0)
    line(out, "box: (", mesh.X.rowwise().minCoeff().transpose().format(kRow), ") to (",
         mesh.X.rowwise().maxCoeff().transpose().format(kRow), ") m");
  describe_sets(out, "node", mesh.node_sets);
  describe_sets(out, "cell", mesh.cell_sets);
  describe_sets(out, "face", mesh.face_sets);
}

void describe_viscoelastic(Out& out, const model::Material& material) {
  if (!material.viscoelastic) return;
  const auto& [g, k, tau, shift] = *material.viscoelastic;
  const auto list = [](const std::vector<double>& values) {
    return join(values, " ", [](double x) { return (std::ostringstream() << x).str(); });
  };
  const auto left = [](const std::vector<double>& relative) {
    return 1 - std::accumulate(relative.begin(), relative.end(), 0.0);
  };
  line(out, "  viscoelastic, moduli above are instantaneous: g = (", list(g), "), k = (", list(k),
       "), tau = (", list(tau), ") s; long-term shares of the moduli: shear ", left(g), ", bulk ", left(k));
  if (shift.law != model::TemperatureShift::Law::none)
    line(out, "  temperature shift ", shift_name(shift.law), ": at ", shift.T, " K times are ",
         model::shift_factor(shift), " times those at ", shift.T_ref, " K");
}

void describe_materials(Out& out, const std::vector<model::MaterialRegion>& regions) {
  for (const auto& [cell_set, material] : regions) {
    const std::string of = "material of " + (cell_set.empty() ? "all other cells" : cell_set) + ": ";
    if (const auto& m = material.orthotropic) {
      line(out, of, "orthotropic, E = (", m->E.transpose().format(kRow), ") Pa, nu_12 nu_13 nu_23 = (",
           m->nu.transpose().format(kRow), "), G_12 G_13 G_23 = (", m->G.transpose().format(kRow),
           ") Pa, axes ", system_name(m->orientation.system), ", rho = ", material.rho, " kg/m^3");
    } else {
      line(out, of, "E = ", material.E, " Pa, nu = ", material.nu, ", rho = ", material.rho, " kg/m^3");
    }
    describe_viscoelastic(out, material);
  }
}

void describe_quality(Out& out, const mesh::Mesh& mesh) {
  const mesh::Quality quality = mesh::quality(mesh);
  line(out, "scaled Jacobian: at least ", quality.min_scaled_jacobian, " (",
       mesh::cell_text(mesh, quality.worst_cell), "), mean ", quality.mean_scaled_jacobian);
  if (const auto cell = mesh::first_inverted_cell(mesh))
    line(out, "inverted: ", mesh::cell_text(mesh, *cell), " is the first, its smallest Jacobian is ",
         mesh::smallest_jacobian(mesh, *cell), " m^3");
}

void describe_joints(Out& out, const mesh::Mesh& mesh, const mesh::ReadReport& report) {
  const mesh::JointFaults faults = mesh::joint_faults(mesh, report);
  if (!faults.overlap.empty()) line(out, "overlap: ", faults.overlap);
  for (const std::string& open : faults.open) line(out, "open: ", open);
}

void describe_mesh_file(Out& out, const std::string& path, const std::string& format) {
  mesh::ReadReport report;
  const mesh::Mesh mesh = mesh::read_mesh(path, 1, &report);
  line(out, "format: ", format, " (units as in the file, taken as SI)");
  describe_mesh(out, mesh);
  describe_quality(out, mesh);
  describe_joints(out, mesh, report);
  describe_materials(out, report.regions);
  for (const std::string& hold : report.restrained) line(out, "restrained by the file: node set ", hold);
  for (const auto& [set, mass] : report.point_mass)
    line(out, "point masses of the file: ", mass, " kg on node set ", set);
  for (const std::string& what : report.read_as) line(out, "element type ", what);
  for (const std::string& what : report.lost) line(out, "lost: ", what);
  for (const std::string& what : report.ignored) line(out, "not read: ", what);
}

void describe_inertia(Out& out, const model::Inertia& inertia) {
  line(out, "mass: ", inertia.m, " kg");
  line(out, "centre of mass: (", inertia.c.transpose(), ") m, body frame");
  line(out, "inertia about the origin: [", inertia.J.format(kRow), "] kg m^2");
  if (!inertia.S_2.empty()) line(out, "invariants: full");
}

// The lowest ones and the highest: "100, 120, 130 to 9000"
std::string frequencies(const Eigen::VectorXd& f) {
  constexpr Eigen::Index kLowest = 6;
  std::ostringstream text;
  for (Eigen::Index i = 0; i < std::min(kLowest, f.size()); ++i) text << (i > 0 ? ", " : "") << f[i];
  if (f.size() > kLowest) text << " to " << f[f.size() - 1];
  return text.str();
}

void describe_modes(Out& out, const std::string& path, const model::ElasticBody& body) {
  line(out, "basis: ", basis_name(body.basis), ", ", counted(body.n_q(), "elastic coordinate"));
  if (body.frequency.size() > 0)
    line(out, "frequencies: ", frequencies(body.frequency.head(body.n_modes())), " Hz");
  if (body.n_attachments > 0)
    line(out, "attachment modes: the last ", counted(body.n_attachments, "coordinate"));
  if (body.basis == model::Basis::modal)
    line(out, "modes are stored at ", has_full_modes(path) ? "all nodes" : "surface and stress nodes only");
  const ModeChecks checks = read_mode_checks(path);
  if (checks.residual.size() > 0)
    line(out, "largest residual: ", checks.residual.maxCoeff(),
         ", largest phi_i' M phi_j: ", checks.orthogonality, ", count proved by inertia");
  line(out, "damping: alpha = ", body.alpha, " 1/s, beta = ", body.beta, " s");
  if (body.zeta.size() > 0) line(out, "damping ratios: ", body.zeta.minCoeff(), " to ", body.zeta.maxCoeff());
}

// Tables of many rows by their range.
void describe_check(Out& out, const model::Check& check) {
  constexpr Eigen::Index kMostRows = 12;
  const std::string unit = check.unit == "1" ? "" : " " + check.unit;
  line(out, "check ", check.name, ": ", check.meaning);
  if (check.value.size() == 0) return;
  if (check.value.rows() > kMostRows)
    return line(out, "  ", check.value.rows(), " rows, ", check.value.minCoeff(), " to ",
                check.value.maxCoeff(), unit);
  for (Eigen::Index i = 0; i < check.value.rows(); ++i)
    line(out, "  ", check.row.empty() ? "" : check.row[static_cast<std::size_t>(i)] + ": ",
         check.value.row(i), unit);
}

// "252 nodes, and 144 in z": of the nodes that have displacements at all.
std::string describe_restraint(const BodySource& source) {
  std::vector<int> held(static_cast<std::size_t>(source.mesh.n_nodes()),
                        source.mesh.cells.size() > 0 ? 0 : mesh::kAllDirections);
  for (int node : source.mesh.cells.nodes) held[node] = mesh::kAllDirections;
  for (int dof : source.free_dof) held[dof / 3] &= ~(1 << dof % 3);
  std::string text = counted(std::count(held.begin(), held.end(), mesh::kAllDirections), "node");
  for (int directions = mesh::kAllDirections - 1; directions > 0; --directions)
    if (const auto n = std::count(held.begin(), held.end(), directions); n > 0)
      text += ", and " + std::to_string(n) + " in " +
              mesh::direction_names(static_cast<mesh::Directions>(directions));
  return text;
}

void describe_body(Out& out, const std::string& path) {
  const model::ElasticBody body = read_body(path);
  const BodySource source = read_body_source(path);
  line(out, "body: ", body.name);
  describe_modes(out, path, body);
  describe_inertia(out, body.inertia);
  line(out, "restraint: ", body.floating ? "none, a free body" : describe_restraint(source));
  line(out, "body frame: origin at (", source.origin.transpose(), ") m of the mesh that was reduced");
  if (std::ranges::count(source.mesh.cells.type, mesh::CellType::hex8) > 0)
    line(out, "element of hex8 cells: ", element_name(source.element),
         source.element_mass == model::ElementMass::condensed ? " (mass condensed)" : "");
  line(out, counted(source.free_dof.size(), "free degree"), " of freedom");
  describe_materials(out, source.regions);
  std::string groups;
  for (const std::string& name : body.surface.group_name) groups += " " + name;
  line(out, "surface: ", counted(body.surface.node.size(), "node"), ", ",
       counted(body.surface.face.cols(), "face"), " in ", counted(body.surface.group_name.size(), "group"),
       groups.empty() ? "" : ":", groups);
  line(out, "stress: ", counted(body.stress.node.size(), "node"), ", recovered by ",
       recovery_name(source.recovery.method),
       source.recovery.method == model::RecoveryMethod::surface
           ? ", forces may act on " + counted(source.recovery.loaded.size(), "node")
           : "");
  for (const model::Marker& marker : body.markers)
    if (marker.area)
      line(out, "marker ", marker.name, ": area along its normals (",
           marker.area->sum.transpose().format(kRow), ") m^2");
    else
      line(out, "marker ", marker.name, ": (", marker.X.transpose().format(kRow), ") m",
           marker.turns ? "" : ", without rotation: its nodes lie on a line");
  describe_sets(out, "stress node", body.stress.sets);
  for (const model::Check& check : source.checks) describe_check(out, check);
  describe_mesh(out, source.mesh);
  describe_map(out, body.provenance);
}

void describe_hdf5(Out& out, const std::string& path) {
  const h5::File file = h5::open(path);
  const std::string format = h5::string_attribute(file, "/", "format");
  line(out, "format: ", format, ", version ", version(file), "; SI units");
  if (format == kBodyFormat.name) return describe_body(out, path);
  if (format == kResultFormat.name) return describe_result(out, path);
  if (format == kEvaluationFormat.name) return describe_evaluation(out, path);
  if (format == kLifeFormat.name) return describe_life(out, path);
  if (format == kWearFormat.name) return describe_wear(out, path);
  require(format == kStressFormat.name, path, ": unknown format '", format, "', known are '",
          kBodyFormat.name, "', '", kResultFormat.name, "', '", kStressFormat.name, "', '",
          kEvaluationFormat.name, "', '", kLifeFormat.name, "', '", kWearFormat.name, "'");
  describe_stress(out, path);
}

bool has_hdf5_signature(const std::string& path) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  std::string start(kSignature.size(), '\0');
  std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  return start == kSignature;
}

}  // namespace

std::string file_format(const std::string& path) {
  require_file(path);
  require(has_hdf5_signature(path), path, ": is no HDF5 file of this program");
  return h5::string_attribute(h5::open(path), "/", "format");
}

std::map<std::string, std::string> read_provenance(const std::string& path) {
  return h5::read_map(h5::open(path), "/provenance");
}

std::string describe(const std::string& path) {
  require_file(path);
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  Out out;
  line(out, "file: ", path);
  if (has_hdf5_signature(path)) {
    describe_hdf5(out, path);
    describe_datasets(out, path);
  } else if (extension == ".msh" || extension == ".inp") {
    describe_mesh_file(out, path, extension == ".msh" ? "Gmsh MSH 4.1" : "Abaqus/CalculiX input");
  } else if (extension == ".vtu" || extension == ".vtp" || extension == ".pvd") {
    describe_vtk(out, path, extension);
  } else if (extension == ".csv") {
    describe_table(out, path);
  } else {
    fail(path,
         ": unknown format; known are .msh, .inp, .vtu, .vtp, .pvd, .csv and the HDF5 files of this program",
         mesh::way_from_bulk_data(path));
  }
  return out.str();
}

}  // namespace elastogear::io
