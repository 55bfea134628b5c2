#pragma once
// The place of a point beside a flank: the half angle there, from which its distance and the flank's normal
// follow.

#include "elastogear/gear/toothing.h"

namespace elastogear::gear {

struct FlankPlace {
  double r = 0;         ///< m, from the axis
  HalfAngle half = {};  ///< there
  double distance = 0;  ///< m, of flank_distance()
};
FlankPlace flank_place(const Toothing& toothing, int tooth, int side, const Eigen::Vector3d& x);

}  // namespace elastogear::gear
