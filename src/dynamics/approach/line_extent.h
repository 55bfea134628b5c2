#pragma once
// How far a line goes on over the faces of a flank.

#include <Eigen/Core>

#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

/// A piece of a line, m from its origin.
struct LineExtent {
  double from = 0, to = 0;
  double face = 0;  ///< the longest piece over one face
};

/// The line through x along a unit vector, over the faces of a group as they are seen against a unit normal:
/// the piece around x. All in the BRF. Without faces there: from = to = face = 0.
LineExtent line_extent(const model::Surface& surface, int group, const Eigen::Vector3d& x,
                       const Eigen::Vector3d& along, const Eigen::Vector3d& normal);

}  // namespace elastogear::dynamics
