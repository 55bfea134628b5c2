#pragma once
// Points of faces that are parts of second-order sides: their displacement is that of the side, by all of its
// nodes (docs/theory, section 6.13).

#include <Eigen/Core>
#include <functional>

#include "elastogear/contact/face.h"

namespace elastogear::contact {

using SecondOrderSide = Eigen::Matrix<int, 8, 1>;  ///< as in model::Surface

/// Weights of a side's nodes in one of its points, less those that the face which is a part of it gives them:
/// docs/theory, Eq. (6.30).
struct SideWeights {
  int n = 0;  ///< nodes: 6 or 8; 0 of a face that is a whole side
  std::array<int, 8> node{};
  std::array<double, 8> d{};
};

/// At (u, v) of a face with these nodes. The point of the side is the one behind that of the face along its
/// normal. position: of nodes, m.
SideWeights side_weights(const SecondOrderSide& side, const Face& face, const Eigen::Vector4i& nodes,
                         const Eigen::Vector2d& at, const std::function<Eigen::Vector3d(int node)>& position);

/// sum_i d_i x_i.
Eigen::Vector3d combine(const SideWeights& weights, const std::function<Eigen::Vector3d(int node)>& x);

}  // namespace elastogear::contact
