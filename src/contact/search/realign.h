#pragma once
// Realignment: the k-DOP around a rotated k-DOP, the paper's first way of keeping a tree valid
// (docs/theory, section 5.1).
//
// The new extent in direction u (in the old frame) is the largest u . x over the old k-DOP's hull points. By
// linear-programming duality it is the smallest of sum_j w_j d_j over all ways to write u = sum_j w_j B_j as
// a positive combination of three plane normals. Any such combination is a valid bound, so the result
// encloses the original whatever the roundoff does to a corner; all combinations give the hull-point value
// itself, and a few of them, chosen once per rotation, give nearly that.

#include <Eigen/Core>
#include <vector>

#include "elastogear/contact/kdop.h"

namespace elastogear::contact {

/// u = sum_j weight_j B_axis_j
struct Combination {
  std::array<int, 3> axis;
  std::array<double, 3> weight;
};

/// Motion x -> R x + r of a k-DOP, prepared for many k-DOPs.
struct Realignment {
  int k = 0;
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  int per_direction = 0;                  ///< combinations kept for each of the k/2 directions
  std::vector<Combination> combinations;  ///< grouped by direction
};

inline constexpr int kAllCombinations = 1 << 20;

/// `per_direction`: how many combinations to keep, those with the smallest weights first (the best for a
/// round body); kAllCombinations gives the hull-point value exactly.
Realignment realignment(int k, const Eigen::Matrix3d& R, const Eigen::Vector3d& r, int per_direction = 4);

/// k-DOP that encloses the moved `dop`.
Kdop realigned(const Kdop& dop, const Realignment& motion);

}  // namespace elastogear::contact
