#pragma once
// How far recovered stresses depend on where within a face the mesh lets contact forces act (docs/theory.md,
// section 4.6).

#include <Eigen/Core>
#include <vector>

#include "elastogear/model/elastic_body.h"
#include "elastogear/recovery/static_response.h"

namespace elastogear::recovery {

/// How the force on a node of the contact surface is spread over n nodes around it. Eq. (4.13).
struct Spread {
  std::vector<int> node;   ///< n, local numbers of surface nodes
  Eigen::VectorXd weight;  ///< n, sums to 1, with its centre at the node
};

/// sides: of the surface, lists of local nodes; those at `node` count. Nodes for which `may_bear` is 0 are
/// left out.
Spread spread(const Eigen::Matrix3Xd& X, const std::vector<std::vector<int>>& sides, int node,
              const std::vector<char>& may_bear);

/// n x n_t, Pa, at mesh nodes: von Mises stress of Eq. (4.14). Empty unless the body file holds the static
/// responses to all forces.
Eigen::MatrixXd contact_error(const StaticResponseOfRun& known_response, const std::vector<int>& nodes);

}  // namespace elastogear::recovery
