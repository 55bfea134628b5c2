#pragma once
// Coulomb friction of a slave point: regularised, by a spring up to its limit, or given (docs/theory,
// section 6.7, Eq. (6.24a)).

#include <Eigen/Core>

namespace elastogear::contact {

/// Friction -limit * direction: changes by -K dz - direction dlimit with its argument z.
struct Friction {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  bool at_limit = true;
};

/// -limit z / sqrt(z^2 + v_0^2), z a velocity in m/s: Eq. (6.17).
Friction regularised(const Eigen::Vector3d& z, double v_0, double limit);

/// A spring of the stiffness c_t (N/m) up to the limit (N), z a displacement in m: Eq. (6.18).
Friction sticking(const Eigen::Vector3d& z, double c_t, double limit);

/// The force t (N) that a unilateral contact is given, z = u a displacement in m, c in m/N. Where it slides
/// its direction turns with u.
Friction given_friction(const Eigen::Vector3d& t, const Eigen::Vector3d& u, double c, double limit,
                        bool slides);

}  // namespace elastogear::contact
