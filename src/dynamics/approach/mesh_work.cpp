#include "dynamics/approach/mesh_work.h"

#include <algorithm>
#include <numbers>

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

using Loads = std::vector<std::pair<int, Vector3d>>;  // N, by node

// One force for each node.
NodalForces sum_by_node(Loads loads) {
  std::stable_sort(loads.begin(), loads.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  NodalForces sum;
  sum.f_B.resize(3, std::ssize(loads));
  for (const auto& [node, force] : loads) {
    if (sum.node.empty() || sum.node.back() != node) {
      sum.f_B.col(std::ssize(sum.node)).setZero();
      sum.node.push_back(node);
    }
    sum.f_B.col(std::ssize(sum.node) - 1) += force;
  }
  sum.f_B.conservativeResize(3, std::ssize(sum.node));
  return sum;
}

// Sets the matrix of blocks of n x n for these nodes. block(a, c) is asked for a >= c.
template <int n, class Among, class Block>
const Eigen::MatrixXd& matrix_among(const std::vector<int>& node, const Block& block, Among& known) {
  if (known.node == node) return known.matrix;
  known.node = node;
  known.matrix.resize(n * std::ssize(node), n * std::ssize(node));
  for (Index a = 0; a < std::ssize(node); ++a)
    for (Index c = 0; c <= a; ++c) {
      const Eigen::Matrix<double, n, n> one =
          block(node[static_cast<std::size_t>(a)], node[static_cast<std::size_t>(c)]);
      known.matrix.template block<n, n>(n * a, n * c) = one;
      known.matrix.template block<n, n>(n * c, n * a) = one.transpose();
    }
  return known.matrix;
}

}  // namespace

const contact::Spread& MeshWork::spread(int node, const Vector3d& along) {
  if (!along.isZero(0)) return across_line_ = half_space_.spread(node, along);
  const auto known = spread_.find(node);
  if (known != spread_.end()) return known->second;
  return spread_.emplace(node, half_space_.spread(node, along)).first->second;
}

// F is symmetric: f' F f - s' F s = (f - s)' F (f + s).
double MeshWork::of(PatchNumber patch, const NodalForces& f, const Vector3d& along,
                    ResidualFlexibility& flexibility) {
  Loads pressures;
  for (Index i = 0; i < f.f_B.cols(); ++i) {
    const contact::Spread& to = spread(f.node[static_cast<std::size_t>(i)], along);
    for (std::size_t k = 0; k < to.node.size(); ++k)
      pressures.emplace_back(to.node[k], to.weight[static_cast<Index>(k)] * f.f_B.col(i));
  }
  const NodalForces p = sum_by_node(std::move(pressures));
  Loads less, more;  // f - s and f + s
  for (Index i = 0; i < f.f_B.cols(); ++i)
    less.emplace_back(f.node[static_cast<std::size_t>(i)], f.f_B.col(i));
  more = less;
  for (Index i = 0; i < p.f_B.cols(); ++i)
    for (const auto& [node, share] : half_space_.pressure(p.node[static_cast<std::size_t>(i)]).nodal_force) {
      less.emplace_back(node, -share * p.f_B.col(i));
      more.emplace_back(node, share * p.f_B.col(i));
    }
  const NodalForces difference = sum_by_node(std::move(less)), sum = sum_by_node(std::move(more));
  const Eigen::MatrixXd& F = matrix_among<3>(
      sum.node, [&](int a, int c) { return flexibility.static_response(a, c); }, F_[patch]);
  const Eigen::MatrixXd& H = matrix_among<1>(
      p.node,
      [&](int a, int c) { return Eigen::Matrix<double, 1, 1>(half_space_.mean_inverse_distance(a, c)); },
      H_[patch]);
  const Vector3d total = f.f_B.rowwise().sum();
  const Eigen::VectorXd normal = p.f_B.transpose() * total.normalized();
  return difference.f_B.reshaped().dot(F * sum.f_B.reshaped()) +
         compliance_ / std::numbers::pi * normal.dot(H * normal);
}

}  // namespace elastogear::dynamics
