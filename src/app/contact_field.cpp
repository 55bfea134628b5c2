#include "app/contact_field.h"

#include "elastogear/contact/topology.h"

namespace elastogear::app {
namespace {

// Fields of contact at the surface nodes.
struct SurfaceFields {
  Eigen::Matrix3Xd force;
  Eigen::RowVectorXd speed;
};

void add(const model::ContactRecord& contact, int side, const Eigen::Matrix4Xi& face, SurfaceFields& fields) {
  if (contact.slave_side == side) {
    fields.force.col(contact.slave_node) += contact.f;
    double& speed = fields.speed[contact.slave_node];
    speed = std::max(speed, contact.slip.norm());
    return;
  }
  // xi, eta of a triangle, whose third and fourth node are one, give its weights, too
  const Eigen::Vector4d N = contact::shape(4, contact.xi, contact.eta).N;
  for (int i = 0; i < 4; ++i) fields.force.col(face(i, contact.face)) -= N[i] * contact.f;
}

}  // namespace

std::vector<io::NodeField> contact_fields(const std::vector<PairAtTime>& pairs, const model::Surface& surface,
                                          Eigen::Index n_nodes) {
  const Eigen::Index n_s = surface.X.cols();
  SurfaceFields fields{Eigen::Matrix3Xd::Zero(3, n_s), Eigen::RowVectorXd::Zero(n_s)};
  for (const PairAtTime& pair : pairs)
    for (const model::ContactRecord& contact : pair.contacts) add(contact, pair.side, surface.face, fields);
  const Eigen::VectorXd area = contact::node_areas(surface.X, surface.face);
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, n_nodes), traction = force,
                  speed = Eigen::MatrixXd::Zero(1, n_nodes);
  for (Eigen::Index i = 0; i < n_s; ++i) {
    const int node = surface.node[static_cast<std::size_t>(i)];
    force.col(node) = fields.force.col(i);
    if (area[i] > 0) traction.col(node) = fields.force.col(i) / area[i];
    speed(0, node) = fields.speed[i];
  }
  return {{"contact_force [N]", force}, {"contact_traction [Pa]", traction}, {"sliding_speed [m/s]", speed}};
}

}  // namespace elastogear::app
