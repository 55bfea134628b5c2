#pragma once
// Contact forces, tractions and sliding speeds on a body's surface as fields at its nodes, for ParaView.

#include <string>
#include <vector>

#include "elastogear/io/field_file.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/result.h"

namespace elastogear::app {

/// The contacts of one pair at one time, and which of its surfaces is the body's.
struct PairAtTime {
  int side;
  std::vector<model::ContactRecord> contacts;
};

/// contact_force (N, world frame), contact_traction (Pa, the same over the node's share of the undeformed
/// surface) and sliding_speed (m/s, of slave nodes) at all n_nodes of the mesh. Master nodes take their share
/// of each force by the shape functions of the face.
std::vector<io::NodeField> contact_fields(const std::vector<PairAtTime>& pairs, const model::Surface& surface,
                                          Eigen::Index n_nodes);

}  // namespace elastogear::app
