#include "elastogear/recovery/contact_field.h"

#include "elastogear/contact/topology.h"
#include "elastogear/io/result_file.h"

namespace elastogear::recovery {
namespace {

// Largest speed at which each surface node slides as a slave, m/s.
Eigen::VectorXd sliding_speed(const BodyContact& contact, Eigen::Index step, Eigen::Index n_surface) {
  Eigen::VectorXd speed = Eigen::VectorXd::Zero(n_surface);
  for (const BodyContact::Pair& pair : contact.pairs)
    for (const model::ContactRecord& record : pair.contacts[static_cast<std::size_t>(step)])
      if (record.slave_side == pair.side)
        speed[record.slave_node] = std::max(speed[record.slave_node], record.slip.norm());
  return speed;
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
                  speed = Eigen::MatrixXd::Zero(1, n_nodes);
  const Eigen::VectorXd area = contact::node_areas(surface.X, surface.face);
  for (std::size_t i = 0; i < contact.forces.node.size(); ++i) {
    const int local = contact.forces.node[i], node = surface.node[local];
    force.col(node) = R_WB * contact.forces.force.block<3, 1>(3 * static_cast<Eigen::Index>(i), step);
    if (area[local] > 0) traction.col(node) = force.col(node) / area[local];
  }
  speed(0, surface.node) = sliding_speed(contact, step, surface.X.cols()).transpose();
  return {{"contact_force [N]", force}, {"contact_traction [Pa]", traction}, {"sliding_speed [m/s]", speed}};
}

}  // namespace elastogear::recovery
