#include "elastogear/reduction/marker.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/mesh/named_nodes.h"

namespace elastogear::reduction {
namespace {

constexpr double kSlenderness = 1e-6;  // of squared lengths: a set thinner than a thousandth lies on a line

using Triplets = std::vector<Eigen::Triplet<double>>;

struct Cloud {
  std::vector<int> nodes;
  Eigen::VectorXd weight;  // of each, their sum is 1
  Eigen::Vector3d mean;
  Eigen::Matrix3d J;  // weighted sum of |r|^2 I - r r' about the mean
};

double area(const mesh::Mesh& mesh, const mesh::Face& face) {
  const Eigen::Vector3d a = mesh.X.col(face[2]) - mesh.X.col(face[0]),
                        b = mesh.X.col(face[3]) - mesh.X.col(face[1]);
  return 0.5 * a.cross(b).norm();
}

// Equal parts of the area of those faces whose nodes are all in the set; `nodes` ascend.
Eigen::VectorXd shares(const mesh::Mesh& mesh, const std::vector<mesh::Face>& faces,
                       const std::vector<int>& nodes) {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nodes.size()));
  const auto in_set = [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  for (const mesh::Face& face : faces) {
    if (!std::all_of(face.begin(), face.end(), in_set)) continue;
    const int n = face[2] == face[3] ? 3 : 4;
    for (int i = 0; i < n; ++i)
      share[std::lower_bound(nodes.begin(), nodes.end(), face[i]) - nodes.begin()] += area(mesh, face) / n;
  }
  return share;
}

// faces: of the outer surface when it is to weigh; nullptr: all nodes weigh the same.
Cloud cloud(const mesh::Mesh& mesh, const std::string& set, const std::vector<mesh::Face>* faces) {
  const std::vector<int> nodes = mesh::named_nodes(mesh, set).node;
  require(!nodes.empty(), "marker '", set, "': the set is empty");
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(nodes.size()));
  if (faces && nodes.size() > 1) weight = shares(mesh, *faces, nodes);
  require(
      weight.sum() > 0, "marker '", set,
      "': no outer face has all its nodes in the set, so that they have no area to weigh by; -marker_weights "
      "equal needs none");
  weight /= weight.sum();
  const Eigen::Matrix3Xd X = mesh.X(Eigen::all, nodes);
  const Eigen::Vector3d mean = X * weight;
  const Eigen::Matrix3Xd r = X.colwise() - mean, w_r = r * weight.asDiagonal();
  return {nodes, weight, mean, r.cwiseProduct(w_r).sum() * Eigen::Matrix3d::Identity() - r * w_r.transpose()};
}

std::vector<mesh::Face> weighing_faces(const mesh::Mesh& mesh, MarkerWeights weights) {
  return weights == MarkerWeights::area ? mesh::boundary_faces(mesh) : std::vector<mesh::Face>();
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
  const std::vector<mesh::Face> faces = weighing_faces(mesh, weights);
  std::vector<model::Marker> markers;
  for (const std::string& set : sets) {
    require(set != model::kFrameMarker, "marker '", set, "': this name stands for the body frame");
    require(std::count(sets.begin(), sets.end(), set) == 1, "marker '", set, "' is named twice");
    const Cloud nodes = cloud(mesh, set, weights == MarkerWeights::area ? &faces : nullptr);
    markers.push_back({set, nodes.mean, turns(nodes), {}});
  }
  return markers;
}

model::SparseRows marker_operator(const mesh::Mesh& mesh, const std::vector<std::string>& sets,
                                  MarkerWeights weights) {
  const std::vector<mesh::Face> faces = weighing_faces(mesh, weights);
  Triplets entries;
  for (int row = 0; const std::string& set : sets) {
    const Cloud nodes = cloud(mesh, set, weights == MarkerWeights::area ? &faces : nullptr);
    Eigen::Matrix3d J_inverse = Eigen::Matrix3d::Zero();
    if (turns(nodes)) J_inverse = nodes.J.inverse();
    for (Eigen::Index i = 0; int node : nodes.nodes) {
      const double w = nodes.weight[i++];
      add_block(w * Eigen::Matrix3d::Identity(), row, 3 * node, entries);
      add_block(w * J_inverse * skew(mesh.X.col(node) - nodes.mean), row + 3, 3 * node, entries);
    }
    row += 6;
  }
  model::SparseRows Q(6 * static_cast<Eigen::Index>(sets.size()), 3 * mesh.n_nodes());
  Q.setFromTriplets(entries.begin(), entries.end());
  return Q;
}

}  // namespace elastogear::reduction
