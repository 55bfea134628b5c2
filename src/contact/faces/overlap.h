#pragma once
// The parts of a slave face that faces of the master lie over, and quadrature on them: faces are cut along
// the sides of the master's, so that integrands are smooth within each part (docs/theory, section 6.13).

#include <Eigen/Core>
#include <array>
#include <vector>

#include "elastogear/contact/face.h"

namespace elastogear::contact {

/// A point of a slave face under a face of the master.
struct OverlapPoint {
  Eigen::Vector2d at;  ///< (u, v) on the slave face
  double area;         ///< m^2, weight
  int master_face;
};

/// A slave face on the plane through its centre.
struct FacePlane {
  const Face& face;                  ///< borrowed
  Eigen::Vector3d centre;            ///< m
  Eigen::Matrix3d axes;              ///< rows: two along the plane, then the outward normal
  std::array<Eigen::Vector2d, 4> x;  ///< m, corners on the plane
  double lowest = 0, highest = 0;    ///< m, of the corners along the normal
};
FacePlane face_plane(const Face& face);

/// How far master faces may be from the plane to be in question, m.
struct OverlapLimits {
  double depth, outside;
  double cos_angle;  ///< of the normals, which must not exceed it
};

/// Returns whether any part of the slave face lies under the master's face, along the normal of the plane,
/// and adds the quadrature points of that part, which are exact for polynomials of degree four on the plane.
bool add_overlap(const FacePlane& slave, const Face& master, int master_face, const OverlapLimits& limits,
                 std::vector<OverlapPoint>& points);

}  // namespace elastogear::contact
