#pragma once
// Motion of a marker, and how it changes with the body's coordinates (docs/theory, section 3.4).

#include "elastogear/body/equations.h"

namespace elastogear::body {

/// Components in the world.
struct MarkerMotion {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();      ///< m
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< marker to world; R_WB in the undeformed body
  Eigen::Vector3d v = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d w = Eigen::Vector3d::Zero();      ///< rad/s
  Eigen::Vector3d a = Eigen::Vector3d::Zero();      ///< m/s^2
};

/// marker: of the body, or nullptr for its frame. Eq. (3.17).
MarkerMotion marker_motion(const Equations& eq, const model::Marker* marker, const Motion& m);

/// Force and moment (N, N m) at a marker, components in the world.
using Wrench = Eigen::Matrix<double, 6, 1>;

/// Generalised force of a wrench. Eq. (3.18).
Force marker_force(const Equations& eq, const model::Marker* marker, const Motion& m, const Wrench& wrench);

/// Changes of x, orientation, v and w (components in the world, three rows each) with s, and with the
/// marker's Phi q; see FrameDerivative. virtual_s: displacement and rotation by the virtual twists H.
struct MarkerDerivative {
  Eigen::Matrix<double, 12, Eigen::Dynamic> by_s;
  Eigen::Matrix<double, 12, 6> by_q;
  Eigen::Matrix<double, 6, Eigen::Dynamic> virtual_s;
};
MarkerDerivative marker_derivative(const Equations& eq, const model::Marker* marker, const Motion& m,
                                   const Shifts& shift);

/// Minus the change of marker_force at a constant wrench: C (n_s x n_s) with s; rho (6 x n_s) of the force on
/// s with Phi q; beta (6 x n_s) of the force on q, Phi' beta, with s; Z of Phi_r' Z Phi_r. Eq. (8.15a).
struct WrenchStiffness {
  Eigen::MatrixXd C, rho, beta;
  Eigen::Matrix3d Z;
};
WrenchStiffness wrench_stiffness(const Equations& eq, const model::Marker* marker, const Motion& m,
                                 const Wrench& wrench);

}  // namespace elastogear::body
