#pragma once
// How the deformation enters the inertia (docs/theory, section 3.1).

#include <Eigen/Core>

#include "elastogear/base/tensor.h"

#include "elastogear/body/equations.h"

namespace elastogear::body {

using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// Y(y) in symmetric(j) y = Y(y) j.
Matrix36 factor(const Eigen::Vector3d& y);

/// The coordinates y of Equations::inertia(), of q, q' or q''.
Eigen::VectorXd to_inertia(const Equations& eq, const Eigen::VectorXd& q);
/// A force on them as one on q.
Eigen::VectorXd from_inertia(const Equations& eq, const Eigen::VectorXd& h_y);

/// Second-order parts of C_r and dJ/dy, linear in x: C_r(y) = C_r + B(y), dJ/dy = J_1 + D(y). Both are
/// bilinear: B_a'= -B_a, D(x)'y = D(y)'x. Eq. (3.11b).
struct SecondOrder {
  Eigen::Matrix<double, Eigen::Dynamic, 3> B;  ///< n_y x 3
  Eigen::Matrix<double, Eigen::Dynamic, 6> D;  ///< n_y x 6, xx yy zz xy yz xz
};
SecondOrder second_order(const Equations& eq, const Eigen::VectorXd& x);

/// The product sum_ab Gamma_ab S^ab x.
Eigen::VectorXd contract(const model::Inertia& inertia, const Eigen::Matrix3d& Gamma,
                         const Eigen::VectorXd& x);

/// m c(q), kg m, about the BRF's origin. Eq. (3.11).
Eigen::Vector3d first_moment(const Equations& eq, const Eigen::VectorXd& y);

/// Inertia about the BRF's origin in the deformed state, and its rates.
struct Shape {
  Eigen::VectorXd y_dot;       ///< n_y
  Eigen::Vector3d S, S_dot;    ///< kg m, kg m/s
  Eigen::Matrix3d J, J_dot;    ///< kg m^2, kg m^2/s
  Eigen::Vector3d spin;        ///< C_r(y)'y', kg m^2/s
  SecondOrder at_y, at_y_dot;  ///< of y and y'; levels affine and full, else empty
};
Shape shape(const Equations& eq, const Motion& m);

/// The product C_r(y)'x.
Eigen::Vector3d project_C_r(const Equations& eq, const Shape& shape, const Eigen::VectorXd& x);

}  // namespace elastogear::body
