#include "elastogear/reduction/marker.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::reduction {
namespace {

constexpr double kSlenderness = 1e-6;  // of squared lengths: a set thinner than a thousandth lies on a line

using Triplets = std::vector<Eigen::Triplet<double>>;

struct Cloud {
  const std::vector<int>& nodes;
  Eigen::Vector3d mean;
  Eigen::Matrix3d J;  // sum of |r|^2 I - r r' about the mean
};

Cloud cloud(const mesh::Mesh& mesh, const std::string& set) {
  const std::vector<int>& nodes = mesh::node_set(mesh, set);
  require(!nodes.empty(), "marker '", set, "': the node set is empty");
  const Eigen::Matrix3Xd X = mesh.X(Eigen::all, nodes);
  const Eigen::Vector3d mean = X.rowwise().mean();
  const Eigen::Matrix3Xd r = X.colwise() - mean;
  return {nodes, mean, r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose()};
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

std::vector<model::Marker> make_markers(const mesh::Mesh& mesh, const std::vector<std::string>& sets) {
  std::vector<model::Marker> markers;
  for (const std::string& set : sets) {
    require(set != model::kFrameMarker, "marker '", set, "': this name stands for the body frame");
    require(std::count(sets.begin(), sets.end(), set) == 1, "marker '", set, "' is named twice");
    const Cloud nodes = cloud(mesh, set);
    markers.push_back({set, nodes.mean, turns(nodes), {}});
  }
  return markers;
}

model::SparseRows marker_operator(const mesh::Mesh& mesh, const std::vector<std::string>& sets) {
  Triplets entries;
  for (int row = 0; const std::string& set : sets) {
    const Cloud nodes = cloud(mesh, set);
    const double n = static_cast<double>(nodes.nodes.size());
    Eigen::Matrix3d J_inverse = Eigen::Matrix3d::Zero();
    if (turns(nodes)) J_inverse = nodes.J.inverse();
    for (int node : nodes.nodes) {
      add_block(Eigen::Matrix3d::Identity() / n, row, 3 * node, entries);
      add_block(J_inverse * skew(mesh.X.col(node) - nodes.mean), row + 3, 3 * node, entries);
    }
    row += 6;
  }
  model::SparseRows Q(6 * static_cast<Eigen::Index>(sets.size()), 3 * mesh.n_nodes());
  Q.setFromTriplets(entries.begin(), entries.end());
  return Q;
}

}  // namespace elastogear::reduction
