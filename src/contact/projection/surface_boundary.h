#pragma once
// Contact at a prolonged open end of the master, over which the share w of the force falls to zero: the
// potential is w(xi) times that of a node on the surface (docs/theory.md, section 6.2).

#include "contact/forces/law.h"

namespace elastogear::contact {

/// -energy dw/dx on the local coordinates, which pushes a node off the end, and its derivative. Eq. (6.2b).
struct EndForce {
  Local F = Local::Zero();                                                    ///< N
  Eigen::Matrix<double, 15, 15> F_x = Eigen::Matrix<double, 15, 15>::Zero();  ///< N/m
};
EndForce end_force(const ProjectionKinematics& foot, const Gap& gap, const NormalForce& whole);

/// Adds it to a contact whose other forces are set. The tangent takes 15 columns then.
void add_end_force(const EndForce& end, ContactPoint& contact);

}  // namespace elastogear::contact
