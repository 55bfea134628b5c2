#pragma once
// Stations over the face of two gears in mesh, to which what bears there is shared out (docs/theory,
// section 10.3).

#include <Eigen/Core>
#include <array>

#include "elastogear/evaluation/motion.h"

namespace elastogear::evaluation {

/// m, ascending, along the axis of gear `along` (0 or 1) in its body frame. On parallel axes they cover what
/// the faces of both gears have in common: its ends and, between them, the layers of the gear whose nodes
/// come into contact. A layer that the end cuts off by less than half of its distance to the next one is
/// none. On crossed axes they are the layers of that gear. Where there are no layers 17 even ones take their
/// place.
Eigen::VectorXd stations(const std::array<const Gear*, 2>& gear, int slave_side, int along);

/// What stands at one place goes to the two stations around it, by linear functions.
struct StationShare {
  std::array<Eigen::Index, 2> station;
  std::array<double, 2> share;  ///< >= 0, their sum is 1
};
/// At least two stations; what lies beyond the ends counts at the end.
StationShare share_out(const Eigen::VectorXd& stations, double z);

/// m, ends of the parts of the face that n stations stand for, n + 1: half way between them, and the first
/// and the last one. Their widths are the integrals of the linear functions.
Eigen::VectorXd ends_of_parts(const Eigen::VectorXd& stations);

}  // namespace elastogear::evaluation
