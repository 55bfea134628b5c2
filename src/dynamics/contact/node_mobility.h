#pragma once
// How easily impulses and forces move the surface nodes of a body.

#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

/// 1/kg, of each surface node, in the direction of x, y or z in which it is largest: change of its velocity
/// in the elastic coordinates by an impulse of 1 N s, with the diagonal of M_r. docs/theory, Eq. (8.18).
Eigen::VectorXd elastic_mobility(const model::ElasticBody& body);

/// kg, of each surface node: that an impulse moves, the motion of the whole body included as if it did not
/// turn; no less than a hundredth of the body.
Eigen::VectorXd node_masses(const model::ElasticBody& body);

/// Marks the surface nodes at which forces have a static response in the file of the body, of which its modes
/// leave more than a part of what the cells at the surface have. docs/theory, section 6.11.
std::vector<bool> responding_nodes(const model::ElasticBody& body);

}  // namespace elastogear::dynamics
