#include "mesh/point_index.h"

#include <algorithm>
#include <cmath>

namespace elastogear::mesh {
namespace {

// Square roots of primes: regular meshes have few nodes in one plane normal to it.
Eigen::Vector3d general_direction() {
  return Eigen::Vector3d(std::sqrt(2), std::sqrt(3), std::sqrt(5)).normalized();
}

}  // namespace

PointIndex::PointIndex(const Eigen::Matrix3Xd& X, std::vector<int> nodes) : X_(X), node_(std::move(nodes)) {
  const Eigen::VectorXd along = X.transpose() * general_direction();
  std::sort(node_.begin(), node_.end(), [&](int a, int b) { return along(a) < along(b); });
  for (int node : node_) along_.push_back(along(node));
}

int PointIndex::find(const Eigen::Vector3d& x, double distance) const {
  const double at = general_direction().dot(x);
  auto i = std::lower_bound(along_.begin(), along_.end(), at - distance) - along_.begin();
  for (; i < static_cast<std::ptrdiff_t>(along_.size()) && along_[i] <= at + distance; ++i)
    if ((X_.col(node_[i]) - x).norm() <= distance) return node_[i];
  return -1;
}

}  // namespace elastogear::mesh
