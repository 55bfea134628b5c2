#include "contact/faces/second_order.h"

#include <Eigen/LU>
#include <algorithm>

namespace elastogear::contact {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Interpolation functions of six or eight nodes and their derivatives with the local coordinates.
struct SideShape {
  std::array<double, 8> N{}, N_a{}, N_b{};
};

// Local coordinates of the nodes: of triangles the weights of the second and third corner.
constexpr std::array<std::array<double, 2>, 6> kTriangle{
    {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};
constexpr std::array<std::array<double, 2>, 8> kSquare{
    {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

SideShape triangle(double a, double b) {
  const double l[3] = {1 - a - b, a, b}, l_a[3] = {-1, 1, 0}, l_b[3] = {-1, 0, 1};
  SideShape s;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    s.N[i] = l[i] * (2 * l[i] - 1);
    s.N_a[i] = l_a[i] * (4 * l[i] - 1);
    s.N_b[i] = l_b[i] * (4 * l[i] - 1);
    s.N[3 + i] = 4 * l[i] * l[j];
    s.N_a[3 + i] = 4 * (l_a[i] * l[j] + l[i] * l_a[j]);
    s.N_b[3 + i] = 4 * (l_b[i] * l[j] + l[i] * l_b[j]);
  }
  return s;
}

SideShape square(double a, double b) {
  SideShape s;
  for (int i = 0; i < 8; ++i) {
    const auto [a_i, b_i] = kSquare[i];
    const double p = 1 + a * a_i, q = 1 + b * b_i;
    if (a_i == 0) {
      s.N[i] = 0.5 * (1 - a * a) * q;
      s.N_a[i] = -a * q;
      s.N_b[i] = 0.5 * (1 - a * a) * b_i;
    } else if (b_i == 0) {
      s.N[i] = 0.5 * p * (1 - b * b);
      s.N_a[i] = 0.5 * a_i * (1 - b * b);
      s.N_b[i] = -p * b;
    } else {
      const double r = a * a_i + b * b_i - 1;
      s.N[i] = 0.25 * p * q * r;
      s.N_a[i] = 0.25 * a_i * q * (r + p);
      s.N_b[i] = 0.25 * b_i * p * (r + q);
    }
  }
  return s;
}

int node_count(const SecondOrderSide& side) { return side[0] < 0 ? 0 : side[6] < 0 ? 6 : 8; }

}  // namespace

SideWeights side_weights(const SecondOrderSide& side, const Face& face, const Eigen::Vector4i& nodes,
                         const Vector2d& at, const std::function<Vector3d(int node)>& position) {
  constexpr int kSteps = 4;  // exact at once on parallelograms and triangles with straight edges
  SideWeights result;
  result.n = node_count(side);
  if (result.n == 0) return result;
  const auto shape_at = [&](const Vector2d& c) {
    return result.n == 6 ? triangle(c[0], c[1]) : square(c[0], c[1]);
  };
  std::array<Vector3d, 8> x;
  for (int i = 0; i < result.n; ++i) x[i] = position(result.node[i] = side[i]);
  const Shape own = shape(face.sides, at[0], at[1]);
  std::array<double, 8> N_face{};
  Vector2d c = Vector2d::Zero();
  for (int k = 0; k < face.sides; ++k) {
    const auto i = static_cast<int>(std::find(side.data(), side.data() + result.n, nodes[k]) - side.data());
    const auto& place = result.n == 6 ? kTriangle[i] : kSquare[i];
    c += own.N[k] * Vector2d(place[0], place[1]);
    N_face[i] += own.N[k];
  }
  SideShape s = shape_at(c);
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix<double, 3, 2> A = Eigen::Matrix<double, 3, 2>::Zero();
    Vector3d rest = Vector3d::Zero();
    for (int i = 0; i < result.n; ++i) {
      A.col(0) += s.N_a[i] * x[i];
      A.col(1) += s.N_b[i] * x[i];
      rest += (N_face[i] - s.N[i]) * x[i];
    }
    c += (A.transpose() * A).inverse() * (A.transpose() * rest);
    s = shape_at(c);
  }
  for (int i = 0; i < result.n; ++i) result.d[i] = s.N[i] - N_face[i];
  return result;
}

Vector3d combine(const SideWeights& weights, const std::function<Vector3d(int node)>& x) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < weights.n; ++i) sum += weights.d[i] * x(weights.node[i]);
  return sum;
}

}  // namespace elastogear::contact
