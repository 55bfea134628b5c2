#pragma once
// Kinematics of a slave node over its closest point x_c = sum_i N_i x_i on a face, edge or vertex of the
// master (docs/theory, section 6.5). Columns of derivatives are the 15 local coordinates:
// slave node, four master nodes, x y z each.

#include <Eigen/Core>

#include "contact/projection/projection.h"

namespace elastogear::contact {

using Local = Eigen::Matrix<double, 15, 1>;
using LocalRow = Eigen::Matrix<double, 1, 15>;
using Local3 = Eigen::Matrix<double, 3, 15>;

/// With derivatives by the first kColumns local coordinates: all 15, or the 3 of the slave node.
template <int kColumns>
struct KinematicsBy {
  using Rows3 = Eigen::Matrix<double, 3, kColumns>;
  int n_dir = 0;  ///< directions in which the closest point can move: face 2, edge 1, vertex 0
  Eigen::Matrix<double, 3, 2> a = Eigen::Matrix<double, 3, 2>::Zero();    ///< m, tangents along them
  Eigen::Matrix<double, 4, 2> N_a = Eigen::Matrix<double, 4, 2>::Zero();  ///< dN/dxi
  Eigen::Vector4d N = Eigen::Vector4d::Zero();
  Eigen::Vector4d N_uv = Eigen::Vector4d::Zero();
  Eigen::Vector3d x_uv = Eigen::Vector3d::Zero();   ///< m, d2x/dudv; edges, vertices: zero
  Eigen::Vector3d d;                                ///< m, x_slave - x_c
  Eigen::Vector3d n;                                ///< as in Projection
  double g = 0;                                     ///< m, as in Projection
  Eigen::Matrix2d A = Eigen::Matrix2d::Identity();  ///< m^2, of A dxi = a.dd at fixed xi + ...
  Eigen::Matrix<double, 2, kColumns> D = Eigen::Matrix<double, 2, kColumns>::Zero();  ///< dxi/dx, 1/m
  Rows3 d_x, n_x;                                                                     ///< dd/dx, dn/dx
};

struct ProjectionKinematics : KinematicsBy<15> {
  Local3 spin;  ///< angular velocity of the master's face, 1/m
  Local3 G;     ///< velocity of the slave node against the master's material carried along to it
};

ProjectionKinematics projection_kinematics(const Face& face, const Projection& projection,
                                           const Eigen::Vector3d& x_slave);

/// What the motion of the slave node alone changes.
KinematicsBy<3> slave_kinematics(const Face& face, const Projection& projection,
                                 const Eigen::Vector3d& x_slave);

/// Angular velocity of a face at (u, v) by the velocities of its four nodes, 1/m: that of its normal, and
/// about the normal the mean of its tangents'; zero where it is degenerate.
Eigen::Matrix<double, 3, 12> face_spin(const Face& face, double u, double v);

/// Derivative da_i/dx of a tangent.
template <int kColumns>
Eigen::Matrix<double, 3, kColumns> tangent_derivative(const KinematicsBy<kColumns>& kinematics, int i);

/// Derivative (dA/dx) y of the metric at constant y.
template <int kColumns>
Eigen::Matrix<double, 2, kColumns> metric_derivative(const KinematicsBy<kColumns>& kinematics,
                                                     const Eigen::Vector2d& y);

/// The matrix [slave I, weight_i I], which sums the local vectors with these weights.
Local3 spread(double slave, const Eigen::Vector4d& weight);

}  // namespace elastogear::contact
