#pragma once
// Contact forces, tractions and sliding speeds on a body's surface as fields at its nodes, for ParaView.

#include <string>
#include <vector>

#include "elastogear/io/field_file.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/result.h"

namespace elastogear::recovery {

/// Contact of one body over a run.
struct BodyContact {
  /// Contacts of one pair at all times, and which of its surfaces (0 or 1) is the body's.
  struct Pair {
    int side = 0;
    std::vector<std::vector<model::ContactRecord>> contacts;
  };
  model::ForceHistory forces;
  std::vector<Pair> pairs;
};

/// Contact of a body of a result file. Error when the result names nodes or faces that the surface lacks.
BodyContact read_body_contact(const std::string& result, const std::string& body,
                              const model::Surface& surface);

/// contact_force (N, world frame), contact_traction (Pa, the same over the node's share of the undeformed
/// surface), contact_pressure (Pa) and sliding_speed (m/s), both of slave nodes, at all n_nodes of the mesh
/// at one output time, at which R_WB turns from the body to the world.
std::vector<io::NodeField> contact_fields(const BodyContact& contact, Eigen::Index step,
                                          const Eigen::Matrix3d& R_WB, const model::Surface& surface,
                                          Eigen::Index n_nodes);

}  // namespace elastogear::recovery
