#include "elastogear/mesh/quality.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"

namespace elastogear::mesh {
namespace {

using Corners = Eigen::Matrix<double, 3, 8>;

// Reference coordinates of the corners, and the three neighbours of each in a right-handed order.
constexpr int kCorner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
constexpr int kNeighbour[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                  {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

Corners corners(const Mesh& mesh, int cell) {
  require(mesh.cells.type[cell] == CellType::hex8, "quality is known for 8-node hexahedra only, cell ", cell,
          " is another type");
  Corners X;
  for (int a = 0; a < 8; ++a) X.col(a) = mesh.X.col(mesh.cells[cell][a]);
  return X;
}

double normalised_triple_product(const Eigen::Matrix3d& A) {
  const double lengths = A.colwise().norm().prod();
  return lengths > 0 ? A.determinant() / lengths : 0;
}

Eigen::Matrix3d jacobian(const Corners& X, const Eigen::Vector3d& xi) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3d c(kCorner[a][0], kCorner[a][1], kCorner[a][2]);
    const Eigen::Vector3d f = Eigen::Vector3d::Ones() + c.cwiseProduct(xi);
    const Eigen::Vector3d dN(c[0] * f[1] * f[2], f[0] * c[1] * f[2], f[0] * f[1] * c[2]);
    J += X.col(a) * dN.transpose() / 8;
  }
  return J;
}

Eigen::Matrix<double, 8, 1> gauss_jacobians(const Mesh& mesh, int cell) {
  const Corners X = corners(mesh, cell);
  Eigen::Matrix<double, 8, 1> det;
  for (int g = 0; g < 8; ++g) {
    const Eigen::Vector3d xi = Eigen::Vector3d(kCorner[g][0], kCorner[g][1], kCorner[g][2]) / std::sqrt(3.0);
    det[g] = jacobian(X, xi).determinant();
  }
  return det;
}

}  // namespace

double scaled_jacobian(const Mesh& mesh, int cell) {
  const Corners X = corners(mesh, cell);
  double smallest = normalised_triple_product(jacobian(X, Eigen::Vector3d::Zero()));
  for (int a = 0; a < 8; ++a) {
    Eigen::Matrix3d edges;
    for (int e = 0; e < 3; ++e) edges.col(e) = X.col(kNeighbour[a][e]) - X.col(a);
    smallest = std::min(smallest, normalised_triple_product(edges));
  }
  return smallest;
}

double gauss_jacobian(const Mesh& mesh, int cell) { return gauss_jacobians(mesh, cell).minCoeff(); }

double volume(const Mesh& mesh, int cell) { return gauss_jacobians(mesh, cell).sum(); }

Quality quality(const Mesh& mesh) {
  require(mesh.cells.size() > 0, "the mesh has no cells, so it has no quality");
  Quality q{.min_scaled_jacobian = 2, .min_gauss_jacobian = gauss_jacobian(mesh, 0)};
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const double sj = scaled_jacobian(mesh, cell);
    if (sj < q.min_scaled_jacobian) q.worst_cell = cell;
    q.min_scaled_jacobian = std::min(q.min_scaled_jacobian, sj);
    q.mean_scaled_jacobian += sj / mesh.cells.size();
    q.min_gauss_jacobian = std::min(q.min_gauss_jacobian, gauss_jacobian(mesh, cell));
  }
  return q;
}

std::optional<int> first_inverted_cell(const Mesh& mesh) {
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    if (!(gauss_jacobian(mesh, cell) > 0)) return cell;
  return std::nullopt;
}

}  // namespace elastogear::mesh
