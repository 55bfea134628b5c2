#include "elastogear/reduction/marker.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/base/sort_unique.h"
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

// Calls visit(N, dA) at the points of a rule that is exact for products of two shape functions on flat sides,
// with the shape functions and the vector of the area there, m^2, outward. X: 3 x n, m. The functions are of
// second degree in each coordinate, whose differences over a unit are their derivatives.
template <class Visit>
void integrate_side(const Eigen::Matrix3Xd& X, const Visit& visit) {
  constexpr double kPoint[] = {-0.7745966692414834, 0, 0.7745966692414834},
                   kWeight[] = {5. / 9, 8. / 9, 5. / 9};
  const int n = static_cast<int>(X.cols());
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
      visit(model::side_shape(n, xi, eta), Eigen::Vector3d(w * along.cross(across)));
    }
}

using Sides = std::vector<std::vector<int>>;  // nodes of each, corners first

bool in(const std::vector<int>& ascending, int i) {
  return std::binary_search(ascending.begin(), ascending.end(), i);
}

// Those whose nodes are all in the set; none unless they hold all of its nodes. `nodes` ascend.
Sides sides_of_set(const Sides& outer, const std::vector<int>& nodes) {
  Sides sides;
  std::vector<int> covered;
  for (const std::vector<int>& side : outer) {
    if (!std::all_of(side.begin(), side.end(), [&](int node) { return in(nodes, node); })) continue;
    sides.push_back(side);
    covered.insert(covered.end(), side.begin(), side.end());
  }
  sort_unique(covered);
  return covered == nodes ? sides : Sides();
}

// Integrals of products of the shape functions of the nodes over the sides; a sum over the nodes without
// sides.
Eigen::SparseMatrix<double> products_of_set(const mesh::Mesh& mesh, const Sides& sides,
                                            const std::vector<int>& nodes) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::SparseMatrix<double> sum(n, n);
  sum.setIdentity();
  if (sides.empty()) return sum;
  Triplets entries;
  const auto place = [&](int node) {
    return static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  for (const std::vector<int>& side : sides)
    integrate_side(mesh.X(Eigen::all, side), [&](const model::SideShape& N, const Eigen::Vector3d& dA) {
      for (Eigen::Index i = 0; i < N.size(); ++i)
        for (Eigen::Index j = 0; j < N.size(); ++j)
          entries.emplace_back(place(side[static_cast<std::size_t>(i)]),
                               place(side[static_cast<std::size_t>(j)]), dA.norm() * N[i] * N[j]);
    });
  sum.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

Cloud cloud(const mesh::Mesh& mesh, const std::string& set, const Sides& outer) {
  const std::vector<int> nodes = mesh::named_nodes(mesh, set).node;
  require(!nodes.empty(), "marker '", set, "': the set is empty");
  Eigen::SparseMatrix<double> products = products_of_set(mesh, sides_of_set(outer, nodes), nodes);
  products /= products.sum();
  const Eigen::VectorXd weight = products * Eigen::VectorXd::Ones(products.cols());
  const Eigen::Matrix3Xd X = mesh.X(Eigen::all, nodes);
  const Eigen::Vector3d mean = X * weight;
  const Eigen::Matrix3Xd r = X.colwise() - mean, arm = r * products;
  return {nodes, weight, mean, arm,
          r.cwiseProduct(arm).sum() * Eigen::Matrix3d::Identity() - r * arm.transpose()};
}

// 3 x nodes, m^2: integrals of the shape functions over the outer sides of a face set, along their normals.
// Empty for node sets, and where a face is none of the surface.
Eigen::Matrix3Xd areas_of_faces(const mesh::Mesh& mesh, const std::string& set, const Sides& outer) {
  if (!mesh::named_nodes(mesh, set).of_faces) return {};
  std::set<mesh::Face> faces;
  for (const mesh::Face& face : mesh::face_set(mesh, set)) faces.insert(mesh::face_key(face));
  Eigen::Matrix3Xd area = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes());
  for (const std::vector<int>& side : outer) {
    const std::vector<mesh::Face> parts = mesh::side_faces(side);
    const auto known = [&](const mesh::Face& part) { return faces.contains(mesh::face_key(part)); };
    if (!std::all_of(parts.begin(), parts.end(), known)) continue;
    for (const mesh::Face& part : parts) faces.erase(mesh::face_key(part));
    integrate_side(mesh.X(Eigen::all, side), [&](const model::SideShape& N, const Eigen::Vector3d& dA) {
      for (Eigen::Index i = 0; i < N.size(); ++i) area.col(side[static_cast<std::size_t>(i)]) += N[i] * dA;
    });
  }
  return faces.empty() ? area : Eigen::Matrix3Xd();
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
  const Sides outer = sets.empty() ? Sides() : mesh::outer_sides(mesh);
  std::vector<model::Marker> markers;
  for (const std::string& set : sets) {
    require(set != model::kFrameMarker, "marker '", set, "': this name stands for the body frame");
    require(std::count(sets.begin(), sets.end(), set) == 1, "marker '", set, "' is named twice");
    const Cloud nodes = cloud(mesh, set, outer);
    markers.push_back({set, nodes.mean, turns(nodes), {}, {}});
    const Eigen::Matrix3Xd area = areas_of_faces(mesh, set, outer);
    if (area.cols() == 0) continue;
    model::AreaVector all{area.rowwise().sum(), Eigen::Vector3d::Zero()};
    for (Eigen::Index i = 0; i < area.cols(); ++i) all.moment += mesh.X.col(i).cross(area.col(i));
    markers.push_back({model::pressure_marker(set), Eigen::Vector3d::Zero(), true, {}, all});
  }
  return markers;
}

model::SparseRows marker_operator(const mesh::Mesh& mesh, const std::vector<std::string>& sets) {
  const Sides outer = sets.empty() ? Sides() : mesh::outer_sides(mesh);
  Triplets entries;
  int row = 0;
  for (const std::string& set : sets) {
    const Cloud nodes = cloud(mesh, set, outer);
    Eigen::Matrix3d J_inverse = Eigen::Matrix3d::Zero();
    if (turns(nodes)) J_inverse = nodes.J.inverse();
    for (Eigen::Index i = 0; int node : nodes.nodes) {
      add_block(nodes.weight[i] * Eigen::Matrix3d::Identity(), row, 3 * node, entries);
      add_block(J_inverse * skew(nodes.arm.col(i)), row + 3, 3 * node, entries);
      ++i;
    }
    row += 6;
    const Eigen::Matrix3Xd area = areas_of_faces(mesh, set, outer);
    if (area.cols() == 0) continue;
    for (int i = 0; i < area.size(); ++i)
      if (area.reshaped()[i] != 0) entries.emplace_back(row, i, area.reshaped()[i]);
    row += 6;
  }
  model::SparseRows Q(row, 3 * mesh.n_nodes());
  Q.setFromTriplets(entries.begin(), entries.end());
  return Q;
}

}  // namespace elastogear::reduction
