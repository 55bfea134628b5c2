#pragma once
// Contact on the extension at a surface boundary of the master, over which the fade factor w falls to zero:
// the potential is w(xi) times that of a node on the surface (docs/theory, section 6.2).

#include "contact/forces/law.h"

namespace elastogear::contact {

/// J, of which the fade factor leaves a part, and its gradients by the local coordinates, N, and velocities,
/// N s.
struct FadingEnergy {
  double e;
  LocalRow e_x, e_v;
};

/// -e dw/dx on the local coordinates, which pushes a node off the boundary, and its derivatives. Eq.
/// (6.2b).
struct BoundaryForce {
  Local F = Local::Zero();                                                    ///< N
  Eigen::Matrix<double, 15, 15> F_x = Eigen::Matrix<double, 15, 15>::Zero();  ///< N/m
  Eigen::Matrix<double, 15, 15> F_v = Eigen::Matrix<double, 15, 15>::Zero();  ///< N s/m
};
BoundaryForce boundary_force(const ProjectionKinematics& kinematics, const Gap& gap, const FadingEnergy& e);

/// Adds it to a contact whose other forces are set. The tangent takes 15 columns then.
void add_boundary_force(const BoundaryForce& boundary, ContactPoint& contact);

}  // namespace elastogear::contact
