#pragma once
// Nodes of second-order sides as shares of the corners: even pressure gives them uneven forces, and their
// corners even ones (docs/theory, section 6.12).

#include <Eigen/Core>
#include <array>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::model {

/// Half of what a node has is each of these corners': those that it stands between, a corner itself twice.
using CornersOfNode = std::array<int, 2>;
std::vector<CornersOfNode> corners_of_nodes(const Surface& surface);

/// Values of nodes, a column each, as sums at the corners; zero at other nodes.
Eigen::MatrixXd sums_at_corners(const std::vector<CornersOfNode>& corners, const Eigen::MatrixXd& of_nodes);

}  // namespace elastogear::model
