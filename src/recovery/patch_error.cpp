#include "elastogear/recovery/patch_error.h"

#include <algorithm>
#include <cmath>

namespace elastogear::recovery {
namespace {

constexpr double kScale = 2;  // of Eq. (1.17)

}  // namespace

PatchError patch_error(const Eigen::Ref<const Eigen::VectorXd>& difference,
                       const Eigen::Ref<const Eigen::VectorXd>& stress, int order) {
  if (difference.size() == 0) return {};
  const double mean = difference.norm() / std::sqrt(static_cast<double>(difference.size())),
               largest = stress.maxCoeff();
  const double share = largest > 0 ? kScale * std::pow(mean / largest, 1. / order) : 1;
  return {mean * std::min(1., share), mean, largest};
}

}  // namespace elastogear::recovery
