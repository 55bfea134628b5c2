#pragma once
// The near-null space of a body's stiffness, for iterative solvers.

#include <Eigen/Core>

#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

/// Unit translations and rotations about the BRF origin in the coordinates of the basis, n_q x 6: S of
/// M_r S = [C_l, C_r] (docs/theory, Eq. (8.12a)). Of a held body it differs from them near the held nodes.
Eigen::MatrixXd rigid_fields(const model::ElasticBody& body);

/// Are the coordinates the displacements x, y, z of one node after the other?
bool is_node_by_node(const model::ElasticBody& body);

}  // namespace elastogear::dynamics
