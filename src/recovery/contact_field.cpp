#include "elastogear/recovery/contact_field.h"

#include "elastogear/contact/topology.h"
#include "elastogear/io/result_file.h"
#include "elastogear/model/corner_shares.h"

namespace elastogear::recovery {
namespace {

// Largest pressure at each surface node as a slave, Pa, and the largest speed at which it slides, m/s.
struct SlaveFields {
  Eigen::VectorXd pressure, speed;
};

SlaveFields slave_fields(const BodyContact& contact, Eigen::Index step, Eigen::Index n_surface) {
  SlaveFields fields{Eigen::VectorXd::Zero(n_surface), Eigen::VectorXd::Zero(n_surface)};
  for (const BodyContact::Pair& pair : contact.pairs)
    for (const model::ContactRecord& record : pair.contacts[static_cast<std::size_t>(step)]) {
      if (record.slave_side != pair.side) continue;
      double &pressure = fields.pressure[record.slave_node], &speed = fields.speed[record.slave_node];
      pressure = std::max(pressure, record.pressure);
      speed = std::max(speed, record.slip.norm());
    }
  return fields;
}

// Forces of the surface's nodes over their shares of the area, Pa: those of corners, and between two corners
// their mean.
Eigen::Matrix3Xd tractions(const model::Surface& surface, const Eigen::Matrix3Xd& force) {
  const std::vector<model::CornersOfNode> corners = model::corners_of_nodes(surface);
  const Eigen::VectorXd of_nodes = contact::node_areas(surface.X, surface.face);
  const Eigen::MatrixXd area = model::sums_at_corners(corners, of_nodes.transpose()),
                        sum = model::sums_at_corners(corners, force);
  Eigen::Matrix3Xd traction = Eigen::Matrix3Xd::Zero(3, force.cols());
  for (Eigen::Index i = 0; i < force.cols(); ++i)
    for (int corner : corners[static_cast<std::size_t>(i)])
      if (area(0, corner) > 0) traction.col(i) += sum.col(corner) / area(0, corner) / 2;
  return traction;
}

}  // namespace

BodyContact read_body_contact(const std::string& result, const std::string& body,
                              const model::Surface& surface) {
  const model::ResultHeader header = io::read_result_header(result);
  BodyContact contact{io::read_contact_forces(result, body, surface), {}};
  for (const auto& pair : header.pairs)
    for (int side : {0, 1})
      if (header.bodies[pair.body[side]].name == body)
        contact.pairs.push_back({side, io::read_contacts(result, pair.name)});
  return contact;
}

std::vector<io::NodeField> contact_fields(const BodyContact& contact, Eigen::Index step,
                                          const Eigen::Matrix3d& R_WB, const model::Surface& surface,
                                          Eigen::Index n_nodes) {
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, n_nodes), traction = force,
                  pressure = Eigen::MatrixXd::Zero(1, n_nodes), speed = pressure;
  for (std::size_t i = 0; i < contact.forces.node.size(); ++i)
    force.col(surface.node[contact.forces.node[i]]) =
        R_WB * contact.forces.force.block<3, 1>(3 * static_cast<Eigen::Index>(i), step);
  traction(Eigen::all, surface.node) = tractions(surface, force(Eigen::all, surface.node));
  const SlaveFields slave = slave_fields(contact, step, surface.X.cols());
  pressure(0, surface.node) = slave.pressure.transpose();
  speed(0, surface.node) = slave.speed.transpose();
  return {{"contact_force [N]", force},
          {"contact_traction [Pa]", traction},
          {"contact_pressure [Pa]", pressure},
          {"sliding_speed [m/s]", speed}};
}

}  // namespace elastogear::recovery
