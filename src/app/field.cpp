#include "app/field.h"

#include "elastogear/fem/stress.h"
#include "elastogear/recovery/error_estimate.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::app {

namespace {

// One body's modes and the stresses of its displacements.
struct Fields {
  const std::string& body_file;
  const io::BodySource& source;

  Eigen::Matrix3Xd displacement(const Eigen::VectorXd& q, const Eigen::VectorXd& u_static) const {
    Eigen::Matrix3Xd u = io::read_displacement_field(body_file, q);
    if (u_static.size() > 0) u += u_static.reshaped(3, u.cols());
    return u;
  }
  Eigen::MatrixXd stress(const Eigen::Matrix3Xd& u) const {  // 6 x n_nodes
    return fem::nodal_stress(source.mesh, source.regions, source.element,
                             Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()));
  }
};

Eigen::VectorXd von_mises(const Eigen::MatrixXd& stress) {
  return recovery::von_mises(Eigen::MatrixXd(stress.reshaped()));
}

Eigen::VectorXd estimated_error(const Fields& fields, const FieldReference& reference,
                                const Eigen::VectorXd& found) {
  const Eigen::MatrixXd whole = fields.stress(fields.displacement(reference.q_d, reference.u_static)),
                        of_modes = fields.stress(fields.displacement(reference.q, {})),
                        upper = fields.stress(fields.displacement(recovery::upper_half(reference.q_d), {}));
  return recovery::field_error({found, von_mises(whole), von_mises(whole - of_modes), von_mises(upper)},
                               reference.share);
}

}  // namespace

void write_field(const std::string& path, const std::string& body_file, const io::BodySource& source,
                 const FieldState& state) {
  const Fields body{body_file, source};
  const Eigen::Matrix3Xd u_B = body.displacement(state.q, state.u_static);
  const Eigen::MatrixXd stress = body.stress(u_B), tensors = stress.reshaped();
  const Eigen::VectorXd equivalent = von_mises(stress);
  mesh::Mesh placed = source.mesh;
  placed.X = (state.R_WB * placed.X).colwise() + state.r_WB;
  std::vector<io::NodeField> fields = {{"displacement [m]", state.R_WB * u_B},
                                       {"stress [Pa]", stress},
                                       {"von_mises [Pa]", equivalent.transpose()},
                                       {"rankine [Pa]", recovery::rankine(tensors).transpose()}};
  if (state.reference)
    fields.push_back(
        {"error_of_von_mises [Pa]", estimated_error(body, *state.reference, equivalent).transpose()});
  fields.insert(fields.end(), state.more.begin(), state.more.end());
  io::write_vtu(path, placed, fields);
}

}  // namespace elastogear::app
