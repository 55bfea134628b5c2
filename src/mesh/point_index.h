#pragma once
// Nodes found by their position.

#include <Eigen/Core>
#include <vector>

namespace elastogear::mesh {

/// Nodes sorted along a direction in general position: those near a point form a short run.
class PointIndex {
 public:
  /// X: 3 x n_nodes, borrowed; only the nodes listed are found.
  PointIndex(const Eigen::Matrix3Xd& X, std::vector<int> nodes);
  /// A node within `distance` of x, or -1.
  int find(const Eigen::Vector3d& x, double distance) const;

 private:
  const Eigen::Matrix3Xd& X_;
  std::vector<int> node_;
  std::vector<double> along_;  // ascending
};

}  // namespace elastogear::mesh
