#pragma once
// Contact integrated over the faces of the slave: one contact point for each of its nodes, with the gap
// weighted by the node's interpolation function (docs/theory, section 6.13).

#include <functional>
#include <map>
#include <vector>

#include "contact/faces/weighted_gap.h"
#include "contact/forces/gap_minima.h"
#include "contact/forces/history.h"

namespace elastogear::contact {

/// What the faces of second-order meshes are parts of, of slave and master.
struct SecondOrder {
  using Sides = Eigen::Matrix<int, 8, Eigen::Dynamic>;  ///< as in model::Surface
  const Sides &slave, &master;
  /// m, that sides are curved by: positions of nodes; where heights hold the undeformed shape, displacements.
  std::function<Eigen::Vector3d(int side, int node)> curved;
};

/// The forces of the faces of a slave.
struct FaceLaws {
  const std::vector<Law>& law;  ///< of each slave node
  const Eigen::VectorXd& area;  ///< m^2, of each slave node, undeformed
  const History& history;       ///< of the slave
  NodeVelocity velocity;
  NodeMotion moved;
};

/// Contacts whose weighted gap is closed or, with the unilateral law, within the reach; by slave node.
/// nodes: those with a gap that is not too large to have one within the reach beside it.
std::vector<ContactPoint> face_contacts(const GapField& field, const SecondOrder& second,
                                        const FaceLaws& laws, const std::map<int, NodeGap>& nodes);

}  // namespace elastogear::contact
