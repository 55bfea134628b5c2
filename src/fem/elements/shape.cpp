#include "fem/elements/shape.h"

#include <array>
#include <vector>

namespace elastogear::fem {
namespace {

using mesh::CellType;

// A function's value and gradient by xi, eta, zeta: products below carry their derivatives along.
struct Jet {
  double value = 0;
  Eigen::RowVector3d gradient = Eigen::RowVector3d::Zero();
};
Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.gradient + b.gradient}; }
Jet operator+(double a, const Jet& b) { return {a + b.value, b.gradient}; }
Jet operator*(double a, const Jet& b) { return {a * b.value, a * b.gradient}; }
Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.value * b.gradient + b.value * a.gradient};
}

using Jets = std::vector<Jet>;
using Coordinates = std::array<Jet, 3>;

Jet bubble(const Jet& x) { return 1 + -1 * (x * x); }

// Trilinear, or the serendipity functions with midside nodes.
Jets hexahedron(CellType type, const Coordinates& x) {
  Jets N;
  const Eigen::Matrix3Xd nodes = reference_nodes(type);
  for (Eigen::Index a = 0; a < nodes.cols(); ++a) {
    const Eigen::Vector3d s = nodes.col(a);
    Jet product{1};
    for (int k = 0; k < 3; ++k) product = product * (s(k) == 0 ? bubble(x[k]) : 1 + s(k) * x[k]);
    const bool midside = s.prod() == 0;
    if (type == CellType::hex20 && !midside)
      product = product * (-2 + (s(0) * x[0] + s(1) * x[1] + s(2) * x[2]));
    N.push_back((midside ? 0.25 : 0.125) * product);
  }
  return N;
}

Jets tetrahedron(CellType type, const Coordinates& x) {
  const Jets L = {1 + -1 * (x[0] + x[1] + x[2]), x[0], x[1], x[2]};
  if (type == CellType::tet4) return L;
  Jets N;
  for (const Jet& l : L) N.push_back(l * (-1 + 2 * l));
  for (const auto& [a, b] : mesh::edges(type)) N.push_back(4 * (L[a] * L[b]));
  return N;
}

// Barycentric coordinates of the triangle times the linear functions of zeta, or the serendipity functions.
Jets wedge(CellType type, const Coordinates& x) {
  const Jets L = {1 + -1 * (x[0] + x[1]), x[0], x[1]}, H = {0.5 * (1 + -1 * x[2]), 0.5 * (1 + x[2])};
  const bool quadratic = type == CellType::wedge15;
  Jets N;
  for (int a = 0; a < 6; ++a) {
    const Jet &l = L[a % 3], &h = H[a / 3];
    N.push_back(quadratic ? l * h * (-1 + 2 * l) + -0.5 * (l * bubble(x[2])) : l * h);
  }
  if (!quadratic) return N;
  for (const auto& [a, b] : mesh::edges(type))
    N.push_back(a / 3 == b / 3 ? 4 * (L[a % 3] * L[b % 3] * H[a / 3]) : L[a % 3] * bubble(x[2]));
  return N;
}

Jets pyramid(const Coordinates& x) {
  const Eigen::Matrix3Xd nodes = reference_nodes(CellType::pyramid5);
  Jets N;
  for (int a = 0; a < 4; ++a)
    N.push_back(0.125 * ((1 + nodes(0, a) * x[0]) * (1 + nodes(1, a) * x[1]) * (1 + -1 * x[2])));
  N.push_back(0.5 * (1 + x[2]));
  return N;
}

Jets jets(CellType type, const Coordinates& x) {
  switch (type) {
    case CellType::tet4:
    case CellType::tet10:
      return tetrahedron(type, x);
    case CellType::wedge6:
    case CellType::wedge15:
      return wedge(type, x);
    case CellType::pyramid5:
      return pyramid(x);
    default:
      return hexahedron(type, x);
  }
}

Eigen::Matrix3Xd corners(CellType type) {
  Eigen::Matrix3Xd X(3, mesh::corner_count(type));
  switch (X.cols()) {
    case 4:
      X << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
      break;
    case 5:
      X << -1, 1, 1, -1, 0, -1, -1, 1, 1, 0, -1, -1, -1, -1, 1;
      break;
    case 6:
      X << 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, -1, -1, -1, 1, 1, 1;
      break;
    default:
      X << -1, 1, 1, -1, -1, 1, 1, -1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, -1, -1, 1, 1, 1, 1;
  }
  return X;
}

}  // namespace

ShapeValues shape_values(CellType type, const Eigen::Vector3d& xi) {
  Coordinates x;
  for (int k = 0; k < 3; ++k) x[k] = {xi(k), Eigen::RowVector3d::Unit(k)};
  const Jets N = jets(type, x);
  const auto n = static_cast<Eigen::Index>(N.size());
  ShapeValues values{Eigen::VectorXd(n), Eigen::MatrixXd(n, 3)};
  for (Eigen::Index a = 0; a < n; ++a) {
    values.N(a) = N[static_cast<std::size_t>(a)].value;
    values.dN.row(a) = N[static_cast<std::size_t>(a)].gradient;
  }
  return values;
}

Eigen::Matrix3Xd reference_nodes(CellType type) {
  const Eigen::Matrix3Xd corner = corners(type);
  Eigen::Matrix3Xd X(3, mesh::node_count(type));
  X.leftCols(corner.cols()) = corner;
  for (Eigen::Index a = corner.cols(); a < X.cols(); ++a) {
    const auto& edge = mesh::edges(type)[static_cast<std::size_t>(a - corner.cols())];
    X.col(a) = (corner.col(edge[0]) + corner.col(edge[1])) / 2;
  }
  return X;
}

}  // namespace elastogear::fem
