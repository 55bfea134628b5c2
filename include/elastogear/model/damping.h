#pragma once
// Damping ratios of modes.

#include <Eigen/Core>
#include <vector>

namespace elastogear::model {

/// A damping ratio over the frequency: linear between the given frequencies, constant below and above them.
struct DampingRatio {
  std::vector<double> frequency;  ///< Hz, ascending; one row: the same ratio everywhere; none: no damping
  std::vector<double> ratio;      ///< -, of critical damping
};

/// Throws Error unless frequencies ascend and ratios are finite and not negative.
void validate(const DampingRatio& damping);

/// One ratio for each frequency (Hz); empty without damping.
Eigen::VectorXd ratios_at(const DampingRatio& damping, const Eigen::VectorXd& frequency);

}  // namespace elastogear::model
