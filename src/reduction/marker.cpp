#include "elastogear/reduction/marker.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/mesh/named_nodes.h"
#include "elastogear/mesh/outer_sides.h"
#include "elastogear/model/side_shape.h"

namespace elastogear::reduction {
namespace {

constexpr double kSlenderness = 1e-6;  // of squared lengths: a set thinner than a thousandth lies on a line

using Triplets = std::vector<Eigen::Triplet<double>>;

struct Cloud {
  std::vector<int> nodes;
  Eigen::VectorXd weight;  // of each, their sum is 1
  Eigen::Vector3d mean;
  Eigen::Matrix3Xd arm;  // of each, from the mean, times its weight
  Eigen::Matrix3d J;     // second moment |r|^2 I - r r' about the mean, over the area
};

// The integrals of products of two shape functions over a side, m^2. X: 3 x n, m. The functions are of second
// degree in each coordinate, whose differences over a unit are their derivatives.
Eigen::MatrixXd side_products(const Eigen::Matrix3Xd& X) {
  constexpr double kPoint[] = {-0.7745966692414834, 0, 0.7745966692414834},
                   kWeight[] = {5. / 9, 8. / 9, 5. / 9};
  const int n = static_cast<int>(X.cols());
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double xi = kPoint[i], eta = kPoint[j], w = kWeight[i] * kWeight[j];
      if (n % 3 == 0) {  // the square is folded into the triangle
        xi = (1 + xi) / 2, eta = (1 + eta) / 2 * (1 - xi);
        w *= (1 - xi) / 4;
      }
      const Eigen::Vector3d along = X * (model::side_shape(n, xi + 0.5, eta) -
                                         model::side_shape(n, xi - 0.5, eta)),
                            across = X * (model::side_shape(n, xi, eta + 0.5) -
                                          model::side_shape(n, xi, eta - 0.5));
      const Eigen::VectorXd N = model::side_shape(n, xi, eta);
      products += w * along.cross(across).norm() * N * N.transpose();
    }
  return products;
}

using Sides = std::vector<std::vector<int>>;  // nodes of each, corners first

// Adds up the sides whose nodes are all in the set; `nodes` ascend.
Eigen::SparseMatrix<double> products_of_set(const mesh::Mesh& mesh, const Sides& sides,
                                            const std::vector<int>& nodes) {
  Triplets entries;
  const auto in_set = [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  const auto place = [&](int node) {
    return static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  for (const std::vector<int>& side : sides) {
    if (!std::all_of(side.begin(), side.end(), in_set)) continue;
    const Eigen::MatrixXd products = side_products(mesh.X(Eigen::all, side));
    for (std::size_t i = 0; i < side.size(); ++i)
      for (std::size_t j = 0; j < side.size(); ++j)
        entries.emplace_back(place(side[i]), place(side[j]), products(i, j));
  }
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::SparseMatrix<double> sum(n, n);
  sum.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

// sides: of the outer surface when it is to weigh; nullptr: all nodes weigh the same.
Cloud cloud(const mesh::Mesh& mesh, const std::string& set, const Sides* sides) {
  const std::vector<int> nodes = mesh::named_nodes(mesh, set).node;
  require(!nodes.empty(), "marker '", set, "': the set is empty");
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::SparseMatrix<double> products(n, n);
  products.setIdentity();
  if (sides && n > 1) products = products_of_set(mesh, *sides, nodes);
  const double all = products.sum();
  require(
      all > 0, "marker '", set,
      "': no outer face has all its nodes in the set, so that they have no area to weigh by; -marker_weights "
      "equal needs none");
  products /= all;
  const Eigen::VectorXd weight = products * Eigen::VectorXd::Ones(n);
  const Eigen::Matrix3Xd X = mesh.X(Eigen::all, nodes);
  const Eigen::Vector3d mean = X * weight;
  const Eigen::Matrix3Xd r = X.colwise() - mean, arm = r * products;
  return {nodes, weight, mean, arm,
          r.cwiseProduct(arm).sum() * Eigen::Matrix3d::Identity() - r * arm.transpose()};
}

Sides weighing_sides(const mesh::Mesh& mesh, MarkerWeights weights) {
  return weights == MarkerWeights::area ? mesh::outer_sides(mesh) : Sides();
}

bool turns(const Cloud& cloud) {
  const Eigen::Vector3d J = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(cloud.J).eigenvalues();
  return J[2] > 0 && J[0] > kSlenderness * J[2];
}

void add_block(const Eigen::Matrix3d& block, int row, int column, Triplets& entries) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (block(i, j) != 0) entries.emplace_back(row + i, column + j, block(i, j));
}

}  // namespace

std::vector<model::Marker> make_markers(const mesh::Mesh& mesh, const std::vector<std::string>& sets,
                                        MarkerWeights weights) {
  const Sides sides = weighing_sides(mesh, weights);
  std::vector<model::Marker> markers;
  for (const std::string& set : sets) {
    require(set != model::kFrameMarker, "marker '", set, "': this name stands for the body frame");
    require(std::count(sets.begin(), sets.end(), set) == 1, "marker '", set, "' is named twice");
    const Cloud nodes = cloud(mesh, set, weights == MarkerWeights::area ? &sides : nullptr);
    markers.push_back({set, nodes.mean, turns(nodes), {}});
  }
  return markers;
}

model::SparseRows marker_operator(const mesh::Mesh& mesh, const std::vector<std::string>& sets,
                                  MarkerWeights weights) {
  const Sides sides = weighing_sides(mesh, weights);
  Triplets entries;
  for (int row = 0; const std::string& set : sets) {
    const Cloud nodes = cloud(mesh, set, weights == MarkerWeights::area ? &sides : nullptr);
    Eigen::Matrix3d J_inverse = Eigen::Matrix3d::Zero();
    if (turns(nodes)) J_inverse = nodes.J.inverse();
    for (Eigen::Index i = 0; int node : nodes.nodes) {
      add_block(nodes.weight[i] * Eigen::Matrix3d::Identity(), row, 3 * node, entries);
      add_block(J_inverse * skew(nodes.arm.col(i)), row + 3, 3 * node, entries);
      ++i;
    }
    row += 6;
  }
  model::SparseRows Q(6 * static_cast<Eigen::Index>(sets.size()), 3 * mesh.n_nodes());
  Q.setFromTriplets(entries.begin(), entries.end());
  return Q;
}

}  // namespace elastogear::reduction
