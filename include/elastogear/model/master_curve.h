#pragma once
// A Prony series from a measured master curve (docs/polymers.md).

#include <Eigen/Core>
#include <string>
#include <vector>

namespace elastogear::model {

/// A modulus at one temperature, over the time of a relaxation test or the frequency of a vibration. Either
/// time and relaxation, or frequency, storage and loss; n entries each, positive, in any order.
struct MasterCurve {
  Eigen::VectorXd time, relaxation;          ///< s, Pa
  Eigen::VectorXd frequency, storage, loss;  ///< Hz, Pa, Pa

  bool over_time() const { return time.size() > 0; }
};

/// Throws Error that begins with `source` for numbers that are not finite or not positive.
void validate(const MasterCurve& curve, const std::string& source);

struct PronyFit {
  double E_0 = 0;               ///< Pa, instantaneous modulus
  std::vector<double> g, tau;   ///< -, s, of the terms that have a share
  double rms = 0, largest = 0;  ///< deviation of the fit, as shares of the (complex) modulus there
};

/// Relaxation times one a decade, over the times of the curve (1 / (2 pi f) of its frequencies).
std::vector<double> decade_times(const MasterCurve& curve);

/// The series with these times that lies closest: least squares of the deviations as shares of the modulus,
/// with long-term modulus and relative moduli that are not negative.
PronyFit fit_prony(const MasterCurve& curve, const std::vector<double>& tau);

}  // namespace elastogear::model
