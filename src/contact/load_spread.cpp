#include "elastogear/contact/load_spread.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

namespace elastogear::contact {
namespace {

// Local nodes of the sides of cells that the surface's faces are parts of: of linear cells the faces
// themselves.
std::vector<std::vector<int>> sides_of(const model::Surface& surface) {
  std::vector<std::vector<int>> sides;
  for (Eigen::Index f = 0; f < surface.face.cols(); ++f) {
    std::vector<int> side;
    for (Eigen::Index i = 0; i < surface.side.rows() && surface.side.cols() > 0; ++i)
      if (surface.side(i, f) >= 0) side.push_back(surface.side(i, f));
    if (side.empty()) side.assign(surface.face.col(f).begin(), surface.face.col(f).end());
    std::sort(side.begin(), side.end());
    side.erase(std::unique(side.begin(), side.end()), side.end());
    sides.push_back(std::move(side));
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  return sides;
}

// For each surface node the numbers of its sides.
std::vector<std::vector<int>> sides_at_nodes(const std::vector<std::vector<int>>& sides, std::size_t n) {
  std::vector<std::vector<int>> at(n);
  for (std::size_t s = 0; s < sides.size(); ++s)
    for (int node : sides[s]) at[static_cast<std::size_t>(node)].push_back(static_cast<int>(s));
  return at;
}

// A mark for each node of the surface: 1 where the body file has its static response, else 0.
std::vector<char> loadable(const model::ElasticBody& body) {
  std::vector<char> may_bear(body.surface.node.size(), 0);
  for (int node : body.flexibility.node) may_bear[static_cast<std::size_t>(node)] = 1;
  return may_bear;
}

}  // namespace

Eigen::VectorXd spread_weights(const Eigen::Matrix3Xd& away) {
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> axes(away, Eigen::ComputeFullU);
  Eigen::Matrix3Xd A(3, away.cols());
  A.row(0).setOnes();
  A.bottomRows<2>() =
      axes.matrixU().leftCols<2>().transpose() * away / std::max(axes.singularValues()[0], 1e-300);
  return A.completeOrthogonalDecomposition().solve(Eigen::Vector3d(1, 0, 0));
}

Spread spread(const Eigen::Matrix3Xd& X, const std::vector<std::vector<int>>& sides, int node,
              const std::vector<char>& may_bear) {
  Spread result;
  for (const std::vector<int>& side : sides)
    for (int other : side)
      if (may_bear[static_cast<std::size_t>(other)] != 0) result.node.push_back(other);
  std::sort(result.node.begin(), result.node.end());
  result.node.erase(std::unique(result.node.begin(), result.node.end()), result.node.end());
  result.weight = spread_weights(X(Eigen::all, result.node).colwise() - X.col(node));
  return result;
}

LoadSpread::LoadSpread(const model::ElasticBody& body)
    : X_(&body.surface.X),
      sides_(sides_of(body.surface)),
      at_node_(sides_at_nodes(sides_, body.surface.node.size())),
      may_bear_(loadable(body)) {}

const Spread& LoadSpread::of(int node) {
  const auto known = known_.find(node);
  if (known != known_.end()) return known->second;
  std::vector<std::vector<int>> around;
  for (int side : at_node_[static_cast<std::size_t>(node)])
    around.push_back(sides_[static_cast<std::size_t>(side)]);
  return known_.emplace(node, spread(*X_, around, node, may_bear_)).first->second;
}

}  // namespace elastogear::contact
