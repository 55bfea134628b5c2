#include "elastogear/mesh/quality.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::mesh {
namespace {

using Corners = Eigen::Matrix<double, 3, 8>;

// Reference coordinates of the corners of hex8.
constexpr int kCorner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

// The three neighbours of each corner in a right-handed order, the edges to them, and the triple product of
// the regular cell.
struct Frames {
  std::vector<std::array<int, 3>> neighbours, edges;
  double regular;
};

Frames frames_of(CellType type, const std::vector<std::array<int, 3>>& neighbours, double regular) {
  Frames frames{neighbours, {}, regular};
  const auto all = edges(type);
  for (int a = 0; a < std::ssize(neighbours); ++a) {
    auto& of_corner = frames.edges.emplace_back();
    for (std::size_t e = 0; e < 3; ++e) {
      const int b = neighbours[a][e];
      const auto joins = [&](const auto& edge) { return std::minmax(edge[0], edge[1]) == std::minmax(a, b); };
      of_corner[e] = static_cast<int>(std::find_if(all.begin(), all.end(), joins) - all.begin());
    }
  }
  return frames;
}

const Frames& frames(CellType type) {
  static const Frames hexahedron =
      frames_of(CellType::hex8,
                {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}, 1);
  static const Frames tetrahedron =
      frames_of(CellType::tet4, {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}, std::sqrt(0.5));
  static const Frames wedge = frames_of(
      CellType::wedge6, {{1, 2, 3}, {2, 0, 4}, {0, 1, 5}, {5, 4, 0}, {3, 5, 1}, {4, 3, 2}}, std::sqrt(0.75));
  static const Frames pyramid =
      frames_of(CellType::pyramid5, {{1, 3, 4}, {2, 0, 4}, {3, 1, 4}, {0, 2, 4}}, std::sqrt(0.5));
  switch (corner_count(type)) {
    case 4:
      return tetrahedron;
    case 5:
      return pyramid;
    case 6:
      return wedge;
    default:
      return hexahedron;
  }
}

Corners hex8_corners(const Mesh& mesh, int cell) {
  require(mesh.cells.type[cell] == CellType::hex8, "the volume is known for 8-node hexahedra only, cell ",
          cell, " is another type");
  return mesh.X(Eigen::all, mesh.cells[cell]);
}

// Tangents of the three edges at a corner, for a reference length of 1; an edge is a parabola when it has a
// midside node.
Eigen::Matrix3d corner_jacobian(const Mesh& mesh, int cell, int corner) {
  const auto nodes = mesh.cells[cell];
  const CellType type = mesh.cells.type[cell];
  const Frames& frame = frames(type);
  const int n_corners = corner_count(type);
  const auto x = [&](int i) { return mesh.X.col(nodes[static_cast<std::size_t>(i)]); };
  Eigen::Matrix3d J;
  for (std::size_t e = 0; e < 3; ++e) {
    const int b = frame.neighbours[corner][e];
    if (node_count(type) == n_corners)
      J.col(e) = x(b) - x(corner);
    else
      J.col(e) = 4 * x(n_corners + frame.edges[corner][e]) - 3 * x(corner) - x(b);
  }
  return J;
}

double normalised_triple_product(const Eigen::Matrix3d& A) {
  const double lengths = A.colwise().norm().prod();
  return lengths > 0 ? A.determinant() / lengths : 0;
}

// Derivatives of the shape functions of hex8 by the reference coordinates.
Eigen::Matrix<double, 8, 3> hex8_derivatives(const Eigen::Vector3d& xi) {
  Eigen::Matrix<double, 8, 3> dN;
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3d c(kCorner[a][0], kCorner[a][1], kCorner[a][2]);
    const Eigen::Vector3d f = Eigen::Vector3d::Ones() + c.cwiseProduct(xi);
    dN.row(a) << c[0] * f[1] * f[2] / 8, f[0] * c[1] * f[2] / 8, f[0] * f[1] * c[2] / 8;
  }
  return dN;
}

Eigen::Matrix<double, 8, 1> gauss_jacobians(const Mesh& mesh, int cell) {
  static const auto derivatives = [] {
    std::array<Eigen::Matrix<double, 8, 3>, 8> all;
    for (std::size_t g = 0; g < 8; ++g)
      all[g] =
          hex8_derivatives(Eigen::Vector3d(kCorner[g][0], kCorner[g][1], kCorner[g][2]) / std::sqrt(3.0));
    return all;
  }();
  const Corners X = hex8_corners(mesh, cell);
  Eigen::Matrix<double, 8, 1> det;
  for (std::size_t g = 0; g < 8; ++g) det[g] = Eigen::Matrix3d(X.lazyProduct(derivatives[g])).determinant();
  return det;
}

// Signs of the reference coordinates of a node of hex20; 0: it is in the middle of an edge along that one.
Eigen::Vector3d hex20_node(int node) {
  const auto corner = [](int a) { return Eigen::Vector3d(kCorner[a][0], kCorner[a][1], kCorner[a][2]); };
  if (node < 8) return corner(node);
  const auto [a, b] = edges(CellType::hex20)[static_cast<std::size_t>(node) - 8];
  return (corner(a) + corner(b)) / 2;
}

// Derivatives of the shape function of a node of hex20 by the reference coordinates.
Eigen::Vector3d hex20_derivatives(int node, const Eigen::Vector3d& xi) {
  const Eigen::Vector3d c = hex20_node(node);
  Eigen::Vector3d f, d;  // factors of the function, each of one coordinate, and their derivatives
  for (int i = 0; i < 3; ++i) {
    f[i] = c[i] == 0 ? 1 - xi[i] * xi[i] : 1 + c[i] * xi[i];
    d[i] = c[i] == 0 ? -2 * xi[i] : c[i];
  }
  const Eigen::Vector3d product(d[0] * f[1] * f[2], f[0] * d[1] * f[2], f[0] * f[1] * d[2]);
  if (node >= 8) return product / 4;
  return (product * (c.dot(xi) - 2) + f.prod() * c) / 8;
}

// Jacobians of hex20 at its 27 integration points.
std::vector<Eigen::Matrix3d> hex20_jacobians(const Mesh& mesh, int cell) {
  static const auto derivatives = [] {
    std::vector<Eigen::Matrix<double, 20, 3>> all;
    for (int g = 0; g < 27; ++g) {
      const Eigen::Vector3i at(g % 3 - 1, g / 3 % 3 - 1, g / 9 - 1);
      const Eigen::Vector3d xi = at.cast<double>() * std::sqrt(0.6);
      auto& dN = all.emplace_back();
      for (int node = 0; node < 20; ++node) dN.row(node) = hex20_derivatives(node, xi);
    }
    return all;
  }();
  const Eigen::Matrix<double, 3, 20> X = mesh.X(Eigen::all, mesh.cells[cell]);
  std::vector<Eigen::Matrix3d> J;
  for (const auto& dN : derivatives) J.emplace_back(X.lazyProduct(dN));
  return J;
}

// The smaller number; a NaN among them is kept.
double smaller(double a, double b) { return b >= a ? a : b; }

}  // namespace

double scaled_jacobian(const Mesh& mesh, int cell) {
  const CellType type = mesh.cells.type[cell];
  const Frames& frame = frames(type);
  double smallest = frame.regular;
  if (type == CellType::hex8) {
    static const Eigen::Matrix<double, 8, 3> at_centre = hex8_derivatives(Eigen::Vector3d::Zero());
    smallest = normalised_triple_product(hex8_corners(mesh, cell).lazyProduct(at_centre));
  }
  for (int a = 0; a < std::ssize(frame.neighbours); ++a)
    smallest = smaller(smallest, normalised_triple_product(corner_jacobian(mesh, cell, a)));
  if (type == CellType::hex20)
    for (const Eigen::Matrix3d& J : hex20_jacobians(mesh, cell))
      smallest = smaller(smallest, normalised_triple_product(J));
  return smallest / frame.regular;
}

double smallest_jacobian(const Mesh& mesh, int cell) {
  if (mesh.cells.type[cell] == CellType::hex8) {
    const auto det = gauss_jacobians(mesh, cell);
    return std::accumulate(det.begin() + 1, det.end(), det[0], smaller);
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (int a = 0; a < std::ssize(frames(mesh.cells.type[cell]).neighbours); ++a)
    smallest = smaller(smallest, corner_jacobian(mesh, cell, a).determinant());
  if (mesh.cells.type[cell] == CellType::hex20)
    for (const Eigen::Matrix3d& J : hex20_jacobians(mesh, cell))
      smallest = smaller(smallest, J.determinant());
  return smallest;
}

double volume(const Mesh& mesh, int cell) { return gauss_jacobians(mesh, cell).sum(); }

Quality quality(const Mesh& mesh) {
  require(mesh.cells.size() > 0, "the mesh has no cells, so it has no quality");
  Quality q{.min_scaled_jacobian = 2, .min_jacobian = smallest_jacobian(mesh, 0)};
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const double sj = scaled_jacobian(mesh, cell);
    if (sj < q.min_scaled_jacobian) q.worst_cell = cell;
    q.min_scaled_jacobian = std::min(q.min_scaled_jacobian, sj);
    q.mean_scaled_jacobian += sj / mesh.cells.size();
    q.min_jacobian = smaller(q.min_jacobian, smallest_jacobian(mesh, cell));
  }
  return q;
}

std::optional<int> first_inverted_cell(const Mesh& mesh) {
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    if (!(smallest_jacobian(mesh, cell) > 0)) return cell;
  return std::nullopt;
}

}  // namespace elastogear::mesh
