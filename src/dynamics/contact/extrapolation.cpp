#include "dynamics/contact/extrapolation.h"

#include <Eigen/QR>

namespace elastogear::dynamics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd Extrapolation::next(const VectorXd& z, const VectorXd& G) {
  constexpr std::size_t kMost = 10;  // earlier calls that are kept
  const VectorXd residual = G - z;
  const auto n = static_cast<Eigen::Index>(G_.size());
  VectorXd result = G;
  if (n > 0) {
    MatrixXd residuals(z.size(), n), values(z.size(), n);
    for (Eigen::Index i = 0; i < n; ++i) {
      residuals.col(i) = residual - residual_[static_cast<std::size_t>(i)];
      values.col(i) = G - G_[static_cast<std::size_t>(i)];
    }
    result -= values * residuals.completeOrthogonalDecomposition().solve(residual);
  }
  G_.push_back(G);
  residual_.push_back(residual);
  if (G_.size() > kMost) {
    G_.erase(G_.begin());
    residual_.erase(residual_.begin());
  }
  return result;
}

}  // namespace elastogear::dynamics
