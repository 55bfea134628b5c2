#pragma once
// From a slave node's projection to its contact point: gap, force, tangent.

#include "contact/forces/force_direction.h"
#include "contact/forces/law.h"

namespace elastogear::contact {

bool on_extension(const Projection& projection);

/// The projection of a slave point at x (m) on the face `before` that it was on, where a smooth surface goes
/// on from there to `now` and the point is hardly past that face; otherwise `now`. Points at an edge then do
/// not jump between faces. The nodes of that face must be placed.
Projection kept_projection(const MasterSide& master, const Projection& now, const Eigen::Vector3d& x,
                           int before);

/// Contact point of the frictionless, undamped penalty on facets, whose F derives from a potential, W = V:
/// docs/theory, Eqs. (6.4) and (6.5). Not for points on an extended side.
ContactPoint potential_contact(const MasterSide& master, const Projection& projection, const Law& law,
                               bool full_tangent);

/// Gap of a slave point at x (m), as open_point gives it.
PointGap point_gap(const MasterSide& master, const Projection& projection, const Eigen::Vector3d& x,
                   double offset);

/// m, the gap alone.
double size_of_gap(const MasterSide& master, const Projection& projection, const Eigen::Vector3d& x,
                   double offset);

/// A slave point over the master, whatever its gap.
struct OpenPoint {
  Projection projection;
  ProjectionKinematics kinematics;
  Gap gap;
};
/// Gap of a slave point at x (m). Smooth surfaces are met on the face itself where the closest point is on an
/// edge or vertex across which normals turn by less than the feature angle.
OpenPoint open_point(const MasterSide& master, const Projection& projection, const Eigen::Vector3d& x,
                     double offset);

/// Sets where on the master a contact sticks from now on: face and (u, v), with the stretch of its spring.
void set_stick_point(const Face& face, int number, const Eigen::Vector2d& at, ContactPoint& contact);

/// Contact point for any law; nothing when the gap is open, unless the law is unilateral. Its slave node and
/// numbers are left to the caller.
struct SlaveContact {
  Eigen::Vector3d v;                                         ///< m/s, of the slave point
  std::function<Eigen::Vector3d(int node)> master_velocity;  ///< m/s
  const StickPoint* stuck;      ///< of this slave point after the last step, or null
  GivenFriction friction = {};  ///< of a unilateral law
};
std::optional<ContactPoint> general_contact(const MasterSide& master, const OpenPoint& open,
                                            const SlaveContact& slave, const Law& law);

}  // namespace elastogear::contact
