#pragma once
// How far recovered stresses depend on where within a face the mesh lets contact forces act (docs/theory.md,
// section 4.6).

#include <Eigen/Core>
#include <vector>

#include "elastogear/model/elastic_body.h"
#include "elastogear/recovery/static_response.h"

namespace elastogear::recovery {

/// n x n_t, Pa, at mesh nodes: von Mises stress of Eq. (4.14). Empty unless the body file holds the static
/// responses to all forces.
Eigen::MatrixXd contact_error(const StaticResponseOfRun& known_response, const std::vector<int>& nodes);

}  // namespace elastogear::recovery
