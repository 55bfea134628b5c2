#include <algorithm>
#include <optional>

#include "elastogear/base/file.h"
#include "elastogear/io/body_file.h"
#include "elastogear/model/fingerprint.h"
#include "io/body/basis_rows.h"
#include "io/body/body_schema.h"
#include "io/body/flexibility_group.h"
#include "io/body/relaxing_group.h"
#include "io/body/row_bounds_group.h"
#include "io/hdf5/checks.h"

namespace elastogear::io {
namespace {

using model::Basis;

void write_second_moments(const h5::File& file, const model::Inertia& inertia, const BodyUnits& unit) {
  if (inertia.S_2.empty()) return;
  h5::make_group(file, "/reduced/S_2");
  for (std::size_t i = 0; i < inertia.S_2.size(); ++i)
    write_matrix(file, std::string("/reduced/S_2/") + kMoments[i], inertia.S_2[i], unit.S_2);
}

void write_inertia(const h5::File& file, const model::Inertia& inertia, const BodyUnits& unit) {
  h5::write<double>(file, "/rigid/mass", view(inertia.m), "kg");
  h5::write<double>(file, "/rigid/center", {{3}, inertia.c.data()}, "m");
  h5::write<double>(file, "/rigid/inertia", {{3, 3}, inertia.J.data()}, "kg m^2");  // symmetric
  const auto n_q = static_cast<hsize_t>(inertia.C_l.rows());
  const model::DenseRows C_l = inertia.C_l, C_r = inertia.C_r;
  h5::write<double>(file, "/reduced/C_l", {{n_q, 3}, C_l.data()}, unit.C_l);
  h5::write<double>(file, "/reduced/C_r", {{n_q, 3}, C_r.data()}, unit.C_r);
  h5::write<double>(file, "/reduced/S_1", {{n_q, 3, 3}, inertia.S_1.data()}, unit.S_1);
  write_second_moments(file, inertia, unit);
}

void write_surface(const h5::File& file, const model::Surface& surface, const BodyUnits& unit) {
  h5::write<int>(file, "/surface/nodes", view(surface.node), "1");
  h5::write<double>(file, "/surface/X", view(surface.X), "m");
  h5::write<int>(file, "/surface/face", {{static_cast<hsize_t>(surface.face.cols()), 4}, surface.face.data()},
                 "1");
  if (surface.side.cols() > 0)
    h5::write<int>(file, "/surface/side",
                   {{static_cast<hsize_t>(surface.side.cols()), 8}, surface.side.data()}, "1");
  h5::write<int>(file, "/surface/group", view(surface.group), "1");
  h5::write_strings(file, "/surface/group_name", surface.group_name);
  h5::write<double>(file, "/surface/c_f", view(surface.c_f), "Pa/m");
  write_rows(file, "/surface/Phi", surface.Phi, 3, unit.Phi);
}

void write_stress(const h5::File& file, const model::Stress& stress, const model::StressRecovery& recovery,
                  const BodyUnits& unit) {
  h5::write<int>(file, "/stress/nodes", view(stress.node), "1");
  h5::write<double>(file, "/stress/X", view(stress.X), "m");
  write_rows(file, "/stress/Psi", stress.Psi, 6, unit.Psi);
  if (recovery.method == model::RecoveryMethod::surface)
    h5::write<int>(file, kLoadedNodes, view(recovery.loaded), "1");
  h5::make_group(file, "/stress/sets");
  for (const auto& [name, members] : stress.sets) {
    require_name(file, name);
    h5::write<int>(file, "/stress/sets/" + name, view(members), "1");
  }
}

void write_markers(const h5::File& file, const model::ElasticBody& body, const BodyUnits& unit) {
  h5::make_group(file, "/markers");
  for (const model::Marker& marker : body.markers) {
    require_name(file, marker.name);
    const std::string group = "/markers/" + marker.name;
    h5::make_group(file, group);
    h5::set_attribute(file, group, "turns", static_cast<int>(marker.turns));
    h5::write<double>(file, group + "/X", {{3}, marker.X.data()}, "m");
    write_rows(file, group + "/Phi", marker.Phi, 6, unit.marker);
    if (!marker.area) continue;
    h5::write<double>(file, group + "/area", {{3}, marker.area->sum.data()}, "m^2");
    h5::write<double>(file, group + "/area_moment", {{3}, marker.area->moment.data()}, "m^3");
  }
}

void write_reduced(const h5::File& file, const model::ElasticBody& body, const BodyUnits& unit) {
  write_square(file, "/reduced/M", body.M_r, {body.basis, unit.M});
  write_square(file, "/reduced/K", body.K_r, {body.basis, unit.K});
  h5::set_attribute(file, "/reduced", "alpha", body.alpha);
  h5::set_attribute(file, "/reduced", "beta", body.beta);
}

void write_modes(const h5::File& file, const model::ElasticBody& body) {
  if (body.basis == Basis::full) return;
  const Eigen::VectorXd eigenvalue = body.K_r.diagonal();
  h5::write<double>(file, "/modes/frequency", view(body.frequency), "Hz");
  h5::write<double>(file, "/modes/eigenvalue", view(eigenvalue), "rad^2/s^2");
  h5::set_attribute(file, "/modes", kAttachments, body.n_attachments);
  if (body.zeta.size() > 0) h5::write<double>(file, "/modes/damping_ratio", view(body.zeta), "1");
}

void write_checks(const h5::File& file, const ModeChecks& checks) {
  if (checks.residual.size() == 0) return;
  h5::write<double>(file, "/checks/residual", view(checks.residual), "1");
  h5::write<double>(file, "/checks/orthogonality", view(checks.orthogonality), "1");
}

// Datasets of E, nu, rho, and for orthotropic materials of the constants and the axes.
void write_material(const h5::File& file, const std::string& group, const model::Material& material) {
  h5::write<double>(file, group + "/rho", view(material.rho), "kg/m^3");
  if (material.viscoelastic) write_viscoelastic(file, group, *material.viscoelastic);
  if (!material.orthotropic) {
    h5::write<double>(file, group + "/E", view(material.E), "Pa");
    h5::write<double>(file, group + "/nu", view(material.nu), "1");
    return;
  }
  const auto write = [&](const char* name, const Eigen::Vector3d& v, const char* unit) {
    h5::write<double>(file, group + name, {{3}, v.data()}, unit);
  };
  const model::Orthotropic& m = *material.orthotropic;
  write("/E", m.E, "Pa");
  write("/nu", m.nu, "1");
  write("/G", m.G, "Pa");
  h5::set_attribute(file, group, "orientation", system_name(m.orientation.system));
  write("/axis_1", m.orientation.axis_1, "1");
  write("/axis_2", m.orientation.axis_2, "1");
  write("/origin", m.orientation.origin, "m");
  write("/axis", m.orientation.axis, "1");
  write("/rotation", m.orientation.rotation, "rad");
}

void write_materials(const h5::File& file, const std::vector<model::MaterialRegion>& regions) {
  h5::make_group(file, "/material");
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const std::string group = "/material/" + std::to_string(i);
    h5::make_group(file, group);
    h5::set_attribute(file, group, "cell_set", regions[i].cell_set);
    write_material(file, group, regions[i].material);
  }
}

void check_source(const model::ElasticBody& body, const BodySource& source, const std::string& path) {
  mesh::validate(source.mesh, path);
  const auto& dof = source.free_dof;
  require(ascends_below(dof, 3 * source.mesh.n_nodes()), path,
          ": free degrees of freedom must ascend within 0..", 3 * source.mesh.n_nodes() - 1);
  require(ascends_below(source.recovery.loaded, source.mesh.n_nodes()), path,
          ": nodes on which forces may act must ascend within 0..", source.mesh.n_nodes() - 1);
  require(body.basis == Basis::modal || static_cast<Eigen::Index>(dof.size()) == body.n_q(), path,
          ": the full basis has ", body.n_q(), " coordinates and ", dof.size(), " free degrees of freedom");
}

}  // namespace

struct BodyWriter::Data {
  PendingFile pending;
  h5::File file;
  hsize_t n_nodes;
  std::vector<bool> written;  // by mode
  h5::Id modes;
  std::optional<ResponseColumns> responses = {};
};

BodyWriter::BodyWriter(const std::string& path, int n_nodes, int n_modes, Precision precision) {
  require(n_nodes >= 0 && n_modes >= 0, path, ": ", n_nodes, " nodes and ", n_modes, " modes");
  data_.reset(new Data{PendingFile(path), {}, static_cast<hsize_t>(n_nodes), std::vector<bool>(n_modes), {}});
  data_->file = h5::create(path, data_->pending.temporary());
  write_format(data_->file, kBodyFormat);
  h5::make_group(data_->file, "/reduced");
  if (n_modes == 0 || n_nodes == 0) return;
  data_->modes =
      h5::create_growing(data_->file, "/modes/Phi",
                         {{data_->n_nodes, 3}, kModalUnits.Phi, false, precision == Precision::float32}, 1);
  h5::set_shape(data_->file, data_->modes, {static_cast<hsize_t>(n_modes), data_->n_nodes, 3});
}

BodyWriter::~BodyWriter() = default;

void BodyWriter::add_modes(int n) {
  data_->written.resize(data_->written.size() + static_cast<std::size_t>(n), false);
  h5::set_shape(data_->file, data_->modes, {data_->written.size(), data_->n_nodes, 3});
}

void BodyWriter::write_mode(int index, const Eigen::VectorXd& phi) {
  const int n_modes = static_cast<int>(data_->written.size());
  require(index >= 0 && index < n_modes, data_->file.path, ": mode ", index, " of 0..", n_modes - 1);
  require(phi.size() == static_cast<Eigen::Index>(3 * data_->n_nodes) && phi.allFinite(), data_->file.path,
          ": mode ", index, " must have ", 3 * data_->n_nodes, " finite entries");
  h5::write_rows(data_->file, data_->modes, {static_cast<hsize_t>(index), {1, data_->n_nodes, 3}},
                 phi.data());
  data_->written[index] = true;
}

void BodyWriter::write_responses(const model::Flexibility& plan, const Eigen::MatrixXf& F,
                                 const Eigen::MatrixXf& G) {
  if (!data_->responses) data_->responses = create_responses(data_->file, plan, F, G);
  io::write_responses(data_->file, *data_->responses, F, G);
}

std::function<Eigen::MatrixXf(int)> BodyWriter::written_responses() const {
  return [&file = data_->file](int orbit) { return read_displacement_responses(file, orbit); };
}

void BodyWriter::finish(const model::ElasticBody& body, const BodySource& source, const ModeChecks& checks) {
  const std::string& path = data_->file.path;
  model::validate(body, path);
  check_source(body, source, path);
  const Eigen::Index n_modes = body.basis == Basis::modal ? body.n_q() : 0;
  const auto n_written = static_cast<Eigen::Index>(data_->written.size());
  const bool complete =
      std::find(data_->written.begin(), data_->written.end(), false) == data_->written.end();
  require(complete && (n_written == 0 || n_written == n_modes) &&
              (checks.residual.size() == 0 || checks.residual.size() == body.n_modes()) &&
              source.mesh.n_nodes() == static_cast<int>(data_->n_nodes),
          path, ": the modes written are not those of the body");
  const std::optional<ResponseColumns>& responses = data_->responses;
  require(!responses || (responses->n_written == responses->n_columns && body.flexibility.F.size() == 0),
          path, ": the responses written are not those of the body");
  const h5::File& file = data_->file;
  const BodyUnits& unit = body_units(body.basis);
  h5::set_attribute(file, "/", "name", body.name);
  h5::set_attribute(file, "/", kIdentity, model::fingerprint(body));
  h5::set_attribute(file, "/", "basis", basis_name(body.basis));
  h5::set_attribute(file, "/", "restraint", std::string(body.floating ? "none" : "nodes"));
  h5::set_attribute(file, "/", "element", element_name(source.element));
  h5::set_attribute(file, "/", kElementMass, element_mass_name(source.element_mass));
  h5::set_attribute(file, "/", kAssembledK, body.assembled_K ? 1 : 0);
  h5::set_attribute(file, "/", kAssembledM, body.assembled_M ? 1 : 0);
  h5::write_map(file, "/provenance", body.provenance);
  write_modes(file, body);
  write_checks(file, checks);
  write_reduced(file, body, unit);
  write_inertia(file, body.inertia, unit);
  write_surface(file, body.surface, unit);
  write_row_bounds(file, body);
  write_stress(file, body.stress, source.recovery, unit);
  write_markers(file, body, unit);
  write_flexibility(file, body.flexibility);
  write_relaxing(file, body, unit.K);
  h5::write<int>(file, "/reduced/free_dof", view(source.free_dof), "1");
  write_mesh(file, source.mesh);
  write_materials(file, source.regions);
  h5::write<double>(file, "/rigid/origin", {{3}, source.origin.data()}, "m");
  write_checks(file, source.checks);
  data_->modes = h5::Id();
  data_->responses.reset();
  h5::close(data_->file);
  data_->pending.commit();
}

}  // namespace elastogear::io
