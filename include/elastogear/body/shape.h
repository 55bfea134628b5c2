#pragma once
// How the deformation enters the inertia (docs/theory.md, section Inertia).

#include <Eigen/Core>

#include "elastogear/body/equations.h"

namespace elastogear::body {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// The symmetric matrix with the entries xx yy zz xy yz xz.
Eigen::Matrix3d symmetric(const Vector6& j);
/// Y(y) in symmetric(j) y = Y(y) j.
Matrix36 factor(const Eigen::Vector3d& y);

/// Second-order parts of C_r and dJ/dq, linear in x: C_r(q) = C_r + B(q), dJ/dq = J_1 + D(q). Both are
/// bilinear: B_a'= -B_a, D(x)'y = D(y)'x.
struct SecondOrder {
  Eigen::Matrix<double, Eigen::Dynamic, 3> B;  ///< n_q x 3
  Eigen::Matrix<double, Eigen::Dynamic, 6> D;  ///< n_q x 6, xx yy zz xy yz xz
};
SecondOrder second_order(const model::Inertia& inertia, const Eigen::VectorXd& x);

/// sum_ab Gamma_ab S^ab x
Eigen::VectorXd contract(const model::Inertia& inertia, const Eigen::Matrix3d& Gamma,
                         const Eigen::VectorXd& x);

/// m c(q), kg m, about the BRF's origin.
Eigen::Vector3d first_moment(const Equations& eq, const Eigen::VectorXd& q);

/// Inertia about the BRF's origin in the deformed state, and its rates.
struct Shape {
  Eigen::Vector3d S, S_dot;    ///< kg m, kg m/s
  Eigen::Matrix3d J, J_dot;    ///< kg m^2, kg m^2/s
  Eigen::Vector3d spin;        ///< C_r(q)'q', kg m^2/s
  SecondOrder at_q, at_q_dot;  ///< of q and q'; level full only, else empty
};
Shape shape(const Equations& eq, const Motion& m);

/// C_r(q)'x
Eigen::Vector3d project_C_r(const Equations& eq, const Shape& shape, const Eigen::VectorXd& x);

}  // namespace elastogear::body
