#include "contact/forces/hermite.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastogear/contact/face.h"

namespace elastogear::contact {
namespace {

constexpr int kLattice = 7;
using LatticeBasis = Eigen::Matrix<double, kLattice, 4>;

constexpr double kLatticeStep = 2.0 / (kLattice - 1);
double lattice(Eigen::Index i) { return kLatticeStep * static_cast<double>(i) - 1; }

// Cubics on [-1, 1] with the value 1, then with the slope 1, at either end.
LatticeBasis lattice_basis() {
  LatticeBasis basis;
  for (int i = 0; i < kLattice; ++i)
    for (int end : {0, 1}) {
      const double t = lattice(i), at = 2 * end - 1;
      basis(i, end) = 0.25 * (2 + 3 * at * t - at * t * t * t);
      basis(i, 2 + end) = 0.25 * (t * t - 1) * (t + at);
    }
  return basis;
}

// How far before the first of equidistant values the parabola through three of them goes on falling; 0 when
// it does not fall there.
double falls_before(double first, double second, double third) {
  const double slope = (-3 * first + 4 * second - third) / (2 * kLatticeStep),
               curvature = (first - 2 * second + third) / (kLatticeStep * kLatticeStep);
  if (!(slope > 0)) return 0;
  return curvature > 0 ? slope / curvature : std::numeric_limits<double>::infinity();
}

// How far beyond an end of a row or column of the lattice its parabola goes on falling; 0 where the least
// value, number `at`, is not at an end.
double falls_beyond(const Eigen::Vector<double, kLattice>& values, Eigen::Index at) {
  if (at == 0) return falls_before(values[0], values[1], values[2]);
  if (at == kLattice - 1) return falls_before(values[at], values[at - 1], values[at - 2]);
  return 0;
}

}  // namespace

LeastOnSide least_of_cubic(const std::array<double, 2>& value, const std::array<double, 2>& slope) {
  // its slope is a + b s + c s^2
  const double a = slope[0], c = 3 * (slope[0] + slope[1] - 2 * (value[1] - value[0])), b = slope[1] - a - c;
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const double s = std::clamp(-2 * a / (b + root), 0.0, 1.0);
  return {value[0] + s * (a + s * (b / 2 + s * c / 3)), s};
}

double lower_bound(const FaceCorners& corners) {
  double bound = -std::numeric_limits<double>::infinity();
  for (int c = 0; c < 4; ++c) {
    const Eigen::Vector2d across = -2 * on_side(4, c, 0);  // to the opposite corner
    bound = std::max(bound, corners.value[c] + across.cwiseProduct(corners.slope.col(c)).cwiseMin(0).sum());
  }
  return bound;
}

LeastOnFace least_of_bicubic(const FaceCorners& corners) {
  static const LatticeBasis basis = lattice_basis();
  Eigen::Matrix4d C = Eigen::Matrix4d::Zero();  // by u, v: values, then slopes
  for (int c = 0; c < 4; ++c) {
    const int i = c == 1 || c == 2, j = c >= 2;
    C(i, j) = corners.value[c];
    C(2 + i, j) = corners.slope(0, c);
    C(i, 2 + j) = corners.slope(1, c);
  }
  const Eigen::Matrix<double, kLattice, kLattice> values = basis * C * basis.transpose();
  Eigen::Index i = 0, j = 0;
  const double least = values.minCoeff(&i, &j);
  const double beyond = std::max(falls_beyond(values.col(j), i), falls_beyond(values.row(i), j));
  return {least, {lattice(i), lattice(j)}, beyond};
}

}  // namespace elastogear::contact
