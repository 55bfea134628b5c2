#pragma once
// The exact flanks behind the faces of a mesh of the worm or the wheel.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "elastogear/gear/design.h"

namespace elastogear::gear {

/// One flank of a toothing.
struct Flank {
  int tooth = 0;  ///< 0-based
  int side = 1;   ///< +1 left, -1 right
};

/// The flank of a face set `tooth_<ii>_left`, `tooth_<ii>_right`, `thread_<i>_left` or `thread_<i>_right` of
/// the meshes; nothing for other names.
std::optional<Flank> flank_of(const std::string& face_set);
/// The flank of a group of faces of a toothing. Those of a worm with one start are in left and right, the
/// sets of all threads, which are as large as thread_1_left and thread_1_right and come first by name.
std::optional<Flank> flank_of(const Toothing& toothing, const std::string& group);

/// Tooth whose centre is nearest to a point of the body frame, and the side of it that the point is on.
Flank nearest_flank(const Toothing& toothing, const Eigen::Vector3d& x);

/// Outward unit normal of the surface of constant flank_distance through x (body frame, m).
Eigen::Vector3d flank_normal(const Toothing& toothing, const Flank& flank, const Eigen::Vector3d& x);

/// Normal curvatures of that surface, 1/m: the symmetric tensor S with n(x + t) = n + S t for small tangents
/// t, by central differences of the normal. > 0: convex.
Eigen::Matrix3d flank_curvature(const Toothing& toothing, const Flank& flank, const Eigen::Vector3d& x);

/// Distance from x along the unit direction n to the flank, m, by Newton's method; NaN where it does not meet
/// the flank near x: where n turns by more than 60 degrees against the flank's normal on the way.
double flank_distance_along(const Toothing& toothing, const Flank& flank, const Eigen::Vector3d& x,
                            const Eigen::Vector3d& n);

}  // namespace elastogear::gear
