#pragma once
// Closest point on a face: its interior (docs/theory, Eq. (6.2)), its sides and its corners.

#include "elastogear/contact/face.h"

namespace elastogear::contact {

enum class Feature {
  face,    ///< foot point inside the face (or on its extension at a surface boundary)
  edge,    ///< on a shared side
  vertex,  ///< at a corner
  outside  ///< at the limit of an extension: beyond the surface
};

struct ClosestPoint {
  Feature feature = Feature::outside;
  int part = 0;                                 ///< side or corner number on the face
  double u = 0, v = 0;                          ///< local coordinates
  Eigen::Vector4d N = Eigen::Vector4d::Zero();  ///< interpolation functions there
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< m
  double distance2 = 0;                         ///< m^2
};

/// Exact to roundoff. Corners may coincide and faces may be warped; positions must be finite.
/// Two faces that share a side find bitwise the same point on it.
ClosestPoint closest_point(const Face& face, const Eigen::Vector3d& q);

/// Tells that q is farther than `distance` (m) from a face, where a plane between both shows it:
/// docs/theory, Eq. (6.2c). Of triangles it is not told.
bool is_farther(const Face& face, const Eigen::Vector3d& q, double distance);

}  // namespace elastogear::contact
