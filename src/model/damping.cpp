#include "elastogear/model/damping.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"

namespace elastogear::model {
namespace {

double ratio_at(const DampingRatio& d, double f) {
  const auto above = std::upper_bound(d.frequency.begin(), d.frequency.end(), f);
  if (above == d.frequency.begin()) return d.ratio.front();
  if (above == d.frequency.end()) return d.ratio.back();
  const std::size_t i = static_cast<std::size_t>(above - d.frequency.begin());
  const double b = (f - d.frequency[i - 1]) / (d.frequency[i] - d.frequency[i - 1]);
  return (1 - b) * d.ratio[i - 1] + b * d.ratio[i];
}

}  // namespace

void validate(const DampingRatio& damping) {
  const auto& [frequency, ratio] = damping;
  require(frequency.size() == ratio.size(), "damping ratio: ", frequency.size(), " frequencies and ",
          ratio.size(), " ratios");
  for (std::size_t i = 0; i < ratio.size(); ++i) {
    require(std::isfinite(ratio[i]) && ratio[i] >= 0, "damping ratio ", ratio[i],
            " must be finite and not negative");
    require(std::isfinite(frequency[i]) && (i == 0 || frequency[i] > frequency[i - 1]),
            "damping ratio: frequency ", frequency[i], " Hz must be finite and above the one before");
  }
}

Eigen::VectorXd ratios_at(const DampingRatio& damping, const Eigen::VectorXd& frequency) {
  if (damping.ratio.empty()) return {};
  return frequency.unaryExpr([&](double f) { return ratio_at(damping, f); });
}

}  // namespace elastogear::model
