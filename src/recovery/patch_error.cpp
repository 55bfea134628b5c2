#include "elastogear/recovery/patch_error.h"

#include <algorithm>
#include <cmath>

namespace elastogear::recovery {
namespace {

constexpr double kScale = 2;     // of Eq. (1.17)
constexpr double kLoaded = 1.3;  // of Eq. (1.18a)

}  // namespace

PatchError patch_error(const Eigen::Ref<const Eigen::VectorXd>& difference,
                       const Eigen::Ref<const Eigen::VectorXd>& stress, int order) {
  if (difference.size() == 0) return {};
  const double mean = difference.norm() / std::sqrt(static_cast<double>(difference.size())),
               largest = stress.maxCoeff();
  const double share = largest > 0 ? kScale * std::pow(mean / largest, 1. / order) : 1;
  return {mean * std::min(1., share), mean, largest};
}

double error_within_surface(const Eigen::Ref<const Eigen::VectorXd>& difference,
                            const Eigen::Ref<const Eigen::VectorXd>& stress, int order) {
  if (difference.size() == 0) return 0;
  const double mean = difference.norm() / std::sqrt(static_cast<double>(difference.size())),
               largest = stress.maxCoeff();
  return mean * (largest > 0 ? std::min(1., kScale * std::pow(mean / largest, 1 - 1. / order)) : 1);
}

double loaded_error(double within, double stress, double share) {
  return kLoaded * std::sqrt(within * stress * share);
}

}  // namespace elastogear::recovery
