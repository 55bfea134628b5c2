#pragma once
// GMRES without restart for I - A with a small A. Private to module dynamics.

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace elastogear::dynamics {

struct GmresLimits {
  double residual;  ///< largest norm of b - (I - A) x
  int steps;
};

/// Solves (I - A) x = b from zero (Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869), with
/// multiply(v) = A v. Returns the coefficients with which the vectors that were multiplied, in their order,
/// make up x; nothing where the limits are not met.
std::optional<Eigen::VectorXd> gmres(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& multiply,
                                     const Eigen::VectorXd& b, const GmresLimits& limits);

}  // namespace elastogear::dynamics
