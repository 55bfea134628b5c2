#pragma once
// Boxes around the faces of an undeformed surface, from which it is seen that a point is far away before the
// surface is deformed.

#include <Eigen/Core>
#include <span>

#include "elastogear/contact/topology.h"

namespace elastogear::contact {

/// Corners of the boxes with the extensions of open ends, m, by face, in the frame of the surface.
struct FaceBoxes {
  Eigen::Matrix3Xd low, high;
};
FaceBoxes face_boxes(const SurfaceView& surface);

/// Distance of a point from the nearest of these boxes, m; infinite without faces.
double distance(const FaceBoxes& boxes, const Eigen::Vector3d& x, std::span<const int> faces);

}  // namespace elastogear::contact
