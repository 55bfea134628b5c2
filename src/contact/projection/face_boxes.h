#pragma once
// Boxes around the faces of an undeformed surface, from which it is seen that a point is far away before the
// surface is deformed.

#include <Eigen/Core>
#include <span>

#include "elastogear/contact/topology.h"

namespace elastogear::contact {

/// Corners of the boxes with the extensions of free boundaries, m, by face, in the frame of the surface.
struct FaceBoxes {
  Eigen::Matrix3Xd low, high;
};
FaceBoxes face_boxes(const SurfaceView& surface);

/// Bounds of the distances from the faces of a surface in motion.
struct FaceBounds {
  const FaceBoxes* boxes;
  SurfaceView undeformed;
  double deformed;    ///< m, no face or extension has a point displaced by more
  Eigen::Matrix3d R;  ///< of the surface's frame in that of positions
  Eigen::Vector3d r;  ///< m

  /// x: m, in the frame of the surface.
  Eigen::Vector3d in_surface(const Eigen::Vector3d& x) const { return R.transpose() * (x - r); }
  /// m, no more than the distance from face f to a point in the frame of the surface.
  double least(int f, const Eigen::Vector3d& x_B) const;
  /// Is face f surely farther than `distance` (m) from a point in the frame of the surface?
  bool is_farther(int f, const Eigen::Vector3d& x_B, double distance) const;
};

/// Distance of a point from the nearest of these boxes, m; infinite without faces.
double distance(const FaceBoxes& boxes, const Eigen::Vector3d& x, std::span<const int> faces);

}  // namespace elastogear::contact
