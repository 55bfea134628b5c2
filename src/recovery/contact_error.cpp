#include "recovery/contact_error.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <map>
#include <utility>

#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {
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

// Delta f by the position of a node in the flexibility, 3 x n_t, N.
std::map<int, Eigen::Matrix3Xd> change_of_forces(const StaticResponseOfRun& known_response) {
  const model::ElasticBody& body = known_response.body;
  const auto sides = sides_of(body.surface);
  const auto at = sides_at_nodes(sides, body.surface.node.size());
  const std::vector<char> may_bear = loadable(body);
  const Eigen::Index n_t = known_response.force.cols();
  std::map<int, Eigen::Matrix3Xd> change;
  for (std::size_t b = 0; b < known_response.position.size(); ++b) {
    const auto f = known_response.force.middleRows(static_cast<Eigen::Index>(3 * b), 3);
    const auto add = [&](int position, double weight) {
      change.try_emplace(position, Eigen::Matrix3Xd::Zero(3, n_t)).first->second += weight * f;
    };
    const int position = known_response.position[b], node = body.flexibility.node[position];
    std::vector<std::vector<int>> around;
    for (int side : at[static_cast<std::size_t>(node)])
      around.push_back(sides[static_cast<std::size_t>(side)]);
    const Spread to = spread(body.surface.X, around, node, may_bear);
    for (std::size_t i = 0; i < to.node.size(); ++i)
      add(model::find_loaded(body.flexibility, to.node[i]), to.weight[static_cast<Eigen::Index>(i)]);
    add(position, -1);
  }
  return change;
}

}  // namespace

Spread spread(const Eigen::Matrix3Xd& X, const std::vector<std::vector<int>>& sides, int node,
              const std::vector<char>& may_bear) {
  Spread result;
  for (const std::vector<int>& side : sides)
    for (int other : side)
      if (may_bear[static_cast<std::size_t>(other)] != 0) result.node.push_back(other);
  std::sort(result.node.begin(), result.node.end());
  result.node.erase(std::unique(result.node.begin(), result.node.end()), result.node.end());
  const Eigen::Matrix3Xd away = X(Eigen::all, result.node).colwise() - X.col(node);
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> axes(away, Eigen::ComputeFullU);
  Eigen::Matrix3Xd A(3, away.cols());
  A.row(0).setOnes();
  A.bottomRows<2>() =
      axes.matrixU().leftCols<2>().transpose() * away / std::max(axes.singularValues()[0], 1e-300);
  result.weight = A.completeOrthogonalDecomposition().solve(Eigen::Vector3d(1, 0, 0));
  return result;
}

Eigen::MatrixXd contact_error(const StaticResponseOfRun& known_response, const std::vector<int>& nodes) {
  if (known_response.position.empty() || nodes.empty()) return {};
  const std::map<int, Eigen::Matrix3Xd> change = change_of_forces(known_response);
  std::vector<int> positions;
  Eigen::MatrixXd force(3 * static_cast<Eigen::Index>(change.size()), known_response.force.cols());
  for (const auto& [position, f] : change) {
    force.middleRows(3 * static_cast<Eigen::Index>(positions.size()), 3) = f;
    positions.push_back(position);
  }
  return von_mises(stored_stress(known_response, positions, force, nodes));
}

}  // namespace elastogear::recovery
