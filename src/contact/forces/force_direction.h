#pragma once
// The direction of contact forces over a smooth master, whose faces have kinks between them once they are
// deformed.

#include <optional>

#include "contact/forces/law.h"
#include "contact/projection/heights.h"
#include "contact/projection/projection.h"

namespace elastogear::contact {

/// The data of the master surface that a pass needs beside the projection.
struct MasterSide {
  const SurfaceView& surface;
  const Heights& heights;
  double feature_angle = 0;  ///< rad
  bool fades = true;         ///< do forces fade out over the extensions?
  bool blends = false;  ///< do forces turn gradually from face to face, where the deformed master has kinks?
};

/// The gap of a slave point over the master, as the slave point alone moves.
struct PointGap {
  Projection projection;
  GapBy<3> gap;
};

/// The gap of a slave point at q (m) over a face of the master that may end before its foot point; nothing
/// without one near.
std::optional<PointGap> gap_over_face(const MasterSide& master, int f, const Eigen::Vector3d& q);

/// What the face beyond a side has where the point is at a distance from it in natural coordinates, 2 across
/// the face, below 0 beyond the side: half at the side, less up to a twentieth of the face's length from it,
/// then nothing.
double share_beyond(double distance);

/// Not of unit length. q: the slave point, m, of which the derivatives are taken.
struct ForceDirection {
  Eigen::Vector3d n;
  Eigen::Matrix3d n_q;  ///< 1/m
};

/// The gradient n of the gap at the foot point w of a slave point at q (m), on a face; near a side that is
/// shared with another face blended with the gradient over that face, half of each at the side: a point that
/// passes from face to face turns its force gradually. xi_q: of the foot point, 1/m. docs/theory, Eq.
/// (6.27a).
ForceDirection force_direction(const MasterSide& master, const Projection& w, const Eigen::Vector3d& q,
                               const ForceDirection& gradient, const Eigen::Matrix<double, 2, 3>& xi_q);

}  // namespace elastogear::contact
