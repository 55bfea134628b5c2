#pragma once
// Normals of the smooth surface behind facets at their nodes (docs/theory, section 6.8).

#include <Eigen/Core>
#include <vector>

#include "elastogear/contact/topology.h"

namespace elastogear::contact {

/// Unit normals at the corners of one face; zero where the face is degenerate.
using CornerNormals = Eigen::Matrix<double, 3, 4>;

/// One entry per face. At each corner a cubic is fitted through the nodes near it, as far as they determine
/// one; where they do not, the result is the mean normal of the faces there, weighted with their angles.
/// Nodes and faces count only when normals turn by less than `feature_angle` (rad) from face to face on the
/// way to them, so that true edges stay sharp.
std::vector<CornerNormals> corner_normals(const SurfaceView& surface, double feature_angle);

}  // namespace elastogear::contact
