#include "elastogear/recovery/mode_acceleration.h"

#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/contact/face.h"

namespace elastogear::recovery {
namespace {

// Calls visit(node, f) for the force of one contact on each of the body's nodes, f in the world frame.
template <class F>
void for_each_node(const model::ContactRecord& contact, int side, const model::Surface& surface, F&& visit) {
  if (contact.slave_side == side) {
    visit(contact.slave_node, contact.f);
    return;
  }
  require(contact.face >= 0 && contact.face < surface.face.cols(), "a contact names face ", contact.face,
          ", the surface has 0..", surface.face.cols() - 1, ": is this the body file of the run?");
  const Eigen::Vector4d N =
      contact::shape(4, contact.xi, contact.eta).N;  // a triangle repeats its third node
  for (int i = 0; i < 4; ++i) visit(surface.face(i, contact.face), Eigen::Vector3d(-N[i] * contact.f));
}

template <class F>
void for_each_force(const std::vector<PairContacts>& pairs, const model::Surface& surface, F&& visit) {
  for (const PairContacts& pair : pairs)
    for (std::size_t t = 0; t < pair.contacts.size(); ++t)
      for (const model::ContactRecord& contact : pair.contacts[t])
        for_each_node(contact, pair.side, surface, [&](int node, const Eigen::Vector3d& f) {
          visit(static_cast<Eigen::Index>(t), node, f);
        });
}

}  // namespace

ForceHistory contact_forces(const std::vector<PairContacts>& pairs, const model::Surface& surface,
                            const Eigen::MatrixXd& R_WB) {
  ForceHistory history;
  auto& nodes = history.node;
  for_each_force(pairs, surface,
                 [&](Eigen::Index, int node, const Eigen::Vector3d&) { nodes.push_back(node); });
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  require(nodes.empty() || (nodes.front() >= 0 && nodes.back() < surface.X.cols()),
          "a contact names a node that the surface does not have: is this the body file of the run?");
  history.force.setZero(3 * static_cast<Eigen::Index>(nodes.size()), R_WB.cols());
  for_each_force(pairs, surface, [&](Eigen::Index t, int node, const Eigen::Vector3d& f) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(R_WB.col(t).data());
    const auto slot = std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin();
    history.force.block<3, 1>(3 * slot, t) += R.transpose() * f;
  });
  return history;
}

Eigen::MatrixXd dynamic_part(const model::ElasticBody& body, const Eigen::MatrixXd& q,
                             const ForceHistory& forces) {
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(q.rows(), q.cols());
  for (std::size_t i = 0; i < forces.node.size(); ++i)
    std::visit(
        [&](const auto& Phi) {
          h += Phi.middleRows(3 * forces.node[i], 3).transpose() *
               forces.force.middleRows(3 * static_cast<Eigen::Index>(i), 3);
        },
        body.surface.Phi);
  return q - body.K_r.diagonal().cwiseInverse().asDiagonal() * h;
}

}  // namespace elastogear::recovery
