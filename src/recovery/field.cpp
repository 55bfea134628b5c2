#include "elastogear/recovery/field.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"
#include "recovery/error_estimate.h"

namespace elastogear::recovery {

namespace {

// One body's modes and the stresses of its displacements.
struct Fields {
  const std::string& body_file;
  const io::BodySource& source;
  const FiniteElements& finite_elements;

  Eigen::Matrix3Xd displacement(const Eigen::VectorXd& q, const Eigen::VectorXd& u_static) const {
    Eigen::Matrix3Xd u = io::read_displacement_field(body_file, q);
    if (u_static.size() > 0) u += u_static.reshaped(3, u.cols());
    return u;
  }
  Eigen::MatrixXd stress(const Eigen::Matrix3Xd& u) const {  // 6 x n_nodes
    return finite_elements.nodal_stress(source, u.reshaped());
  }
};

// Takes the stress that viscoelastic regions have relaxed from that at their nodes. docs/theory, Eq.
// (4.10).
void subtract_relaxed(const Fields& fields, const Eigen::MatrixXd& w, Eigen::MatrixXd& stress) {
  if (w.cols() == 0) return;
  const std::vector<int> node_region = fields.finite_elements.node_regions(fields.source);
  const model::ElasticBody body = io::read_body(fields.body_file, io::BodyUse::motion);
  for (std::size_t p = 0; p < body.relaxing.size(); ++p) {
    const model::RelaxingPart& part = body.relaxing[p];
    const Eigen::MatrixXd of_part = stress_of_part(
        fields.stress(fields.displacement(w.col(static_cast<Eigen::Index>(p)), {})).reshaped(), part.part);
    for (std::size_t node = 0; node < node_region.size(); ++node)
      if (const int r = node_region[node]; r >= 0 && fields.source.regions[r].cell_set == part.cell_set)
        stress.col(static_cast<Eigen::Index>(node)) -=
            of_part.col(0).segment<6>(static_cast<Eigen::Index>(6 * node));
  }
}

Eigen::VectorXd von_mises_at_nodes(const Eigen::MatrixXd& stress) {
  return von_mises(Eigen::MatrixXd(stress.reshaped()));
}

Eigen::VectorXd estimated_error(const Fields& fields, const FieldReference& reference,
                                const Eigen::VectorXd& found) {
  const Eigen::MatrixXd whole = fields.stress(fields.displacement(reference.q_d, reference.u_static)),
                        of_modes = fields.stress(fields.displacement(reference.q, {})),
                        upper = fields.stress(fields.displacement(reference.q_upper, {}));
  return field_error(
      {found, von_mises_at_nodes(whole), von_mises_at_nodes(whole - of_modes), von_mises_at_nodes(upper)},
      reference.share);
}

// The loaded nodes whose faces have a tangent plane, with the error of their means by displacements u.
LoadedNodes loaded_nodes(const Fields& fields, const std::vector<int>& touched, const Eigen::Matrix3Xd& u,
                         const Eigen::VectorXd& found) {
  const bool averaged = fields.source.recovery.method == model::RecoveryMethod::average;
  const std::vector<int>& all = averaged ? touched : fields.source.recovery.loaded;
  const Eigen::VectorXd stress =
      fields.finite_elements.difference_within_surface(fields.source, touched, all) * u.reshaped();
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(found.size());
  difference(all) = von_mises(Eigen::MatrixXd(stress));
  LoadedNodes loaded;
  std::copy_if(all.begin(), all.end(), std::back_inserter(loaded.node),
               [&](int node) { return difference[node] > 0; });
  loaded.within = difference(loaded.node);
  if (averaged) return loaded;
  SurfacePatches patches = fields.finite_elements.surface_patches(fields.source, loaded.node);
  for (std::size_t i = 0; i < loaded.node.size(); ++i) {
    std::vector<int>& patch = patches.node[i];
    std::erase_if(patch, [&](int node) { return difference[node] == 0; });
    loaded.within[static_cast<Eigen::Index>(i)] =
        error_within_surface(difference(patch), found(patch), patches.order[i]);
  }
  return loaded;
}

// Eqs. (1.17) and (1.18a), of displacements u.
Eigen::VectorXd estimated_mesh_error(const Fields& fields, const std::vector<int>& touched,
                                     const Eigen::Matrix3Xd& u, const Eigen::VectorXd& found) {
  const Eigen::VectorXd difference =
      von_mises_at_nodes(fields.finite_elements.stress_difference(fields.source, touched, u.reshaped()));
  SurfacePatches patches;
  if (fields.source.recovery.method == model::RecoveryMethod::surface) {
    std::vector<int> free;
    for (int i = 0; i < difference.size(); ++i)
      if (difference[i] > 0) free.push_back(i);
    patches = fields.finite_elements.surface_patches(fields.source, free);
  }
  return mesh_error_field(difference, found, std::move(patches), loaded_nodes(fields, touched, u, found));
}

}  // namespace

void write_field(const std::string& path, const std::string& body_file, const io::BodySource& source,
                 const FieldState& state, const FiniteElements& finite_elements) {
  const Fields body{body_file, source, finite_elements};
  const Eigen::Matrix3Xd u_B = body.displacement(state.q, state.u_static);
  Eigen::MatrixXd stress = body.stress(u_B);
  subtract_relaxed(body, state.w, stress);
  const Eigen::MatrixXd tensors = stress.reshaped();
  const Eigen::VectorXd equivalent = von_mises_at_nodes(stress);
  auto placed = source.mesh;
  placed.X = (state.R_WB * placed.X).colwise() + state.r_WB;
  std::vector<io::NodeField> fields = {{"displacement [m]", state.R_WB * u_B},
                                       {"stress [Pa]", stress},
                                       {"von_mises [Pa]", equivalent.transpose()},
                                       {"rankine [Pa]", rankine(tensors).transpose()}};
  if (state.reference)
    fields.push_back(
        {"error_of_von_mises [Pa]", estimated_error(body, *state.reference, equivalent).transpose()});
  if (state.touched)
    fields.push_back({"error_of_von_mises_by_mesh [Pa]",
                      estimated_mesh_error(body, *state.touched, u_B, equivalent).transpose()});
  if (state.q_error.size() > 0)
    fields.push_back({"error_of_von_mises_by_steps [Pa]",
                      von_mises_at_nodes(body.stress(body.displacement(state.q_error, {}))).transpose()});
  fields.insert(fields.end(), state.more.begin(), state.more.end());
  io::write_vtu(path, placed, fields);
}

}  // namespace elastogear::recovery
