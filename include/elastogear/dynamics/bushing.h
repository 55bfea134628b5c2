#pragma once
// The force law of a bushing, a spring and damper in all six directions between two markers (docs/theory,
// section 3.5). Its axes are fixed to the first marker; z is the one about which it may turn all the way.

#include "elastogear/body/marker.h"

namespace elastogear::dynamics {

struct BushingLaw {
  Eigen::Vector3d k = Eigen::Vector3d::Zero();    ///< N/m, along the axes
  Eigen::Vector3d k_r = Eigen::Vector3d::Zero();  ///< N m/rad, about the axes
  Eigen::Vector3d c = Eigen::Vector3d::Zero();    ///< N s/m
  Eigen::Vector3d c_r = Eigen::Vector3d::Zero();  ///< N m s/rad
};

/// A law and where it is unloaded.
struct Bushing {
  BushingLaw law;
  Eigen::Matrix3d A_1, A_2;  ///< the axes in the frames of the markers, parallel when unloaded
  Eigen::Vector3d d_0;       ///< m, from the first marker to the second when unloaded, along the axes
};

/// Unloaded where the markers are now, with axes `A` in the world.
Bushing make_bushing(const BushingLaw& law, const Eigen::Matrix3d& A, const body::MarkerMotion& first,
                     const body::MarkerMotion& second);

struct BushingForce {
  Eigen::Vector3d d, d_dot;       ///< m, m/s, displacement of the second marker, along the axes
  Eigen::Vector3d angle, w;       ///< rad, tilt about x and y, turn about z; rad/s
  Eigen::Vector3d force, torque;  ///< N, N m, on the second marker, components in the world
  double energy;                  ///< J, stored

  /// Wrench on the first marker, which takes the force at the place of the second: [-f; -m - r x f].
  body::Wrench on_first(const Eigen::Vector3d& r) const;
  body::Wrench on_second() const;
};
/// Displacement, angles, force and torque of a bushing: Eqs. (3.19) and (3.21).
BushingForce bushing_force(const Bushing& bushing, const body::MarkerMotion& first,
                           const body::MarkerMotion& second);

/// Change of [on_first; on_second] with x, orientation, v, w of the first and of the second marker, all
/// components in the world.
Eigen::Matrix<double, 12, 24> bushing_derivative(const Bushing& bushing, const body::MarkerMotion& first,
                                                 const body::MarkerMotion& second);

/// W, taken by the dampers at these rates.
double dissipation(const BushingLaw& law, const Eigen::Vector3d& d_dot, const Eigen::Vector3d& w);

/// Throws Error, beginning with `who`, for values that are not finite or negative.
void validate(const BushingLaw& law, const std::string& who);

/// Angles of a rotation and the torque of springs about them (Eqs. (3.20) and (3.21)), components along
/// the axes: the change of the torque with a further rotation is `derivative`.
struct TiltAndTurn {
  Eigen::Vector3d angle, torque;
  double energy;
  Eigen::Matrix3d derivative;
};
TiltAndTurn tilt_and_turn(const Eigen::Vector3d& k_r, const Eigen::Matrix3d& R);

}  // namespace elastogear::dynamics
