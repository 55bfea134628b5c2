#pragma once
// Points of a surface's faces by the coordinates that results have of them.

#include <Eigen/Core>

#include "elastogear/model/elastic_body.h"

namespace elastogear::model {

/// Shares of the four nodes of a face at xi, eta, Eq. (6.1). A triangle has its third and fourth node in one
/// place, and its coordinates are those of this quadrilateral, too.
Eigen::Vector4d face_shares(double xi, double eta);

/// m, BRF, on the undeformed surface.
Eigen::Vector3d point_on_face(const Surface& surface, int face, double xi, double eta);

}  // namespace elastogear::model
