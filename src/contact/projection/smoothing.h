#pragma once
// How far the smooth surface behind a faceted one stands out of each facet: a cubic height over the face
// whose slopes at the corners follow the normals at the nodes (docs/theory, section 6.8).

#include <Eigen/Core>
#include <vector>

#include "elastogear/contact/topology.h"

namespace elastogear::contact {

/// Slopes of the height with the face's (u, v) at its corners, m.
using CornerSlopes = Eigen::Matrix<double, 2, 4>;

/// One entry per face, from corner_normals with the same feature_angle (rad).
std::vector<CornerSlopes> corner_slopes(const SurfaceView& undeformed, double feature_angle);

/// Height at (u, v) along the face normal, m.
double smooth_height(int sides, const CornerSlopes& slopes, double u, double v);

}  // namespace elastogear::contact
