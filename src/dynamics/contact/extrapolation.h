#pragma once
// Fixed points z = G(z) of maps that need not contract, by Anderson's extrapolation from the last pairs (z,
// G(z)).

#include <Eigen/Core>
#include <vector>

namespace elastogear::dynamics {

class Extrapolation {
 public:
  /// The next z from the last one and what the map makes of it: exact for an affine map after as many calls
  /// as its rank, one more at most.
  Eigen::VectorXd next(const Eigen::VectorXd& z, const Eigen::VectorXd& G);

 private:
  std::vector<Eigen::VectorXd> G_, residual_;  // of earlier calls, the last one at the end
};

}  // namespace elastogear::dynamics
