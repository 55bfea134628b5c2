#include "elastogear/model/corner_shares.h"

namespace elastogear::model {

std::vector<CornersOfNode> corners_of_nodes(const Surface& surface) {
  std::vector<CornersOfNode> corners;
  for (int node = 0; node < surface.X.cols(); ++node) corners.push_back({node, node});
  for (const auto& side : surface.side.colwise()) {
    const Eigen::Index n = (side.array() >= 0).count() / 2;
    for (Eigen::Index i = 0; i < n; ++i)
      corners[static_cast<std::size_t>(side[n + i])] = {side[i], side[(i + 1) % n]};
  }
  return corners;
}

Eigen::MatrixXd sums_at_corners(const std::vector<CornersOfNode>& corners, const Eigen::MatrixXd& of_nodes) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(of_nodes.rows(), of_nodes.cols());
  for (Eigen::Index i = 0; i < of_nodes.cols(); ++i)
    for (int corner : corners[static_cast<std::size_t>(i)]) sums.col(corner) += of_nodes.col(i) / 2;
  return sums;
}

}  // namespace elastogear::model
