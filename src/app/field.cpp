#include "app/field.h"

#include "elastogear/fem/stress.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::app {

void write_field(const std::string& path, const std::string& body_file, const io::BodySource& source,
                 const FieldState& state) {
  Eigen::Matrix3Xd u_B = io::read_displacement_field(body_file, state.q);
  if (state.u_static.size() > 0) u_B += state.u_static.reshaped(3, u_B.cols());
  const Eigen::MatrixXd stress = fem::nodal_stress(source.mesh, source.regions, source.element,
                                                   Eigen::Map<const Eigen::VectorXd>(u_B.data(), u_B.size()));
  const Eigen::MatrixXd tensors = Eigen::Map<const Eigen::MatrixXd>(stress.data(), stress.size(), 1);
  mesh::Mesh placed = source.mesh;
  placed.X = (state.R_WB * placed.X).colwise() + state.r_WB;
  std::vector<io::NodeField> fields = {{"displacement [m]", state.R_WB * u_B},
                                       {"stress [Pa]", stress},
                                       {"von_mises [Pa]", recovery::von_mises(tensors).transpose()},
                                       {"rankine [Pa]", recovery::rankine(tensors).transpose()}};
  fields.insert(fields.end(), state.more.begin(), state.more.end());
  io::write_vtu(path, placed, fields);
}

}  // namespace elastogear::app
