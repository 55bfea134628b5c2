#include "elastogear/recovery/contact_field.h"

#include "elastogear/contact/topology.h"
#include "elastogear/io/result_file.h"

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
  const Eigen::VectorXd area = contact::node_areas(surface.X, surface.face);
  for (std::size_t i = 0; i < contact.forces.node.size(); ++i) {
    const int local = contact.forces.node[i], node = surface.node[local];
    force.col(node) = R_WB * contact.forces.force.block<3, 1>(3 * static_cast<Eigen::Index>(i), step);
    if (area[local] > 0) traction.col(node) = force.col(node) / area[local];
  }
  const SlaveFields slave = slave_fields(contact, step, surface.X.cols());
  pressure(0, surface.node) = slave.pressure.transpose();
  speed(0, surface.node) = slave.speed.transpose();
  return {{"contact_force [N]", force},
          {"contact_traction [Pa]", traction},
          {"contact_pressure [Pa]", pressure},
          {"sliding_speed [m/s]", speed}};
}

}  // namespace elastogear::recovery
