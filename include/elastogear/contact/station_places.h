#pragma once
// Places of stations, where two exact flanks are nearest to each other: one minimisation in one variable each
// (docs/theory, section 6.18).

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "elastogear/contact/exact_flanks.h"
#include "elastogear/contact/strip_kernel.h"

namespace elastogear::contact {

/// x_owner = r + R x_mate of one point.
struct RelativePlacement {
  Eigen::Matrix3d R;
  Eigen::Vector3d r;  ///< m
};

/// A flank of each of two bodies: stations stand on the owner, the mate is what they come near to.
struct FlankPair {
  const ExactFlanks* owner;
  FlankName on_owner;
  const ExactFlanks* mate;
  FlankName on_mate;
};

/// Where the faces of both flanks end, in the z of their charts, m.
struct FaceEnds {
  static constexpr Strip kNone{-std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};
  Strip owner = kNone, mate = kNone;
};

/// One station where the two flanks, as rigid bodies carry them, are nearest to each other.
struct NearestPlace {
  Strip face;         ///< m, its piece of the owner's face, in z; of a point its place, without length
  double v;           ///< m, on the owner
  double mate_v;      ///< m, on the mate
  double mate_z;      ///< m
  double gap;         ///< m, < 0 where the flanks overlap; deviations and rounded edges of both are in it
  double flank_gap;   ///< m, without the rounded edges: that of a flank and one behind it is deep below 0
  Eigen::Vector3d n;  ///< normal from the mate to the owner, owner's frame: the gap's gradient
};

/// The places of stations on these strips of the owner's face. Eq. (6.50). ends: see nearest_point.
std::vector<NearestPlace> nearest_places(const FlankPair& flanks, const RelativePlacement& placement,
                                         const std::vector<Strip>& strips, const FaceEnds& ends = {});

/// m: by how much the gap opens at the distances h to both sides of a place, across the profile, m; the mean
/// of both, beyond what its slope makes.
double opening(const FlankPair& flanks, const RelativePlacement& placement, const NearestPlace& place,
               double h);

/// How a place changes as the mate moves against the owner.
struct PlaceRates {
  double v, mate_v;           ///< m, for each unit of the motion
  Eigen::Vector3d n, mate_n;  ///< of the normal, in the owner's frame and in the mate's
  double opening;             ///< m, at the distances h to both sides
};
/// twist: [velocity of the owner's origin; angular velocity] of the mate, in the owner's frame. radius: m, of
/// relative curvature across a chart's v.
PlaceRates place_rates(const FlankPair& flanks, const RelativePlacement& placement, const NearestPlace& place,
                       const Eigen::Matrix<double, 6, 1>& twist, double h);

/// The place (v, z) where two flanks on axes that cross are nearest to each other, from any start.
NearestPlace nearest_point(const FlankPair& flanks, const FaceEnds& ends, const RelativePlacement& placement,
                           const Eigen::Vector2d& start);

/// Principal relative curvatures there, 1/m, over the distance h to both sides, m.
struct PrincipalCurvatures {
  double least, largest;
};
PrincipalCurvatures curvatures(const FlankPair& flanks, const FaceEnds& ends,
                               const RelativePlacement& placement, const NearestPlace& place, double h);

/// How places (v, z) measure the surface along a line of contact (slope, 1).
struct LineScale {
  double along = 1;   ///< -, length along the line for each m of z
  double across = 1;  ///< -, distance across it for each m of v
};
LineScale line_scale(const FlankPoint& point, double slope);

}  // namespace elastogear::contact
