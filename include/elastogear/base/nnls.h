#pragma once
// Linear least squares with coefficients that must not be negative.

#include <Eigen/Core>

namespace elastogear {

/// x >= 0 with the least |A x - b|; the active sets of C. L. Lawson and R. J. Hanson (Solving Least Squares
/// Problems, 1974, chapter 23). Of columns that depend on each other some get zero.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace elastogear
