#include "dynamics/approach/half_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "elastogear/contact/face.h"
#include "elastogear/contact/topology.h"

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Mean of 1/r between two points of a rectangle with the sides a and b.
double mean_within(double a, double b) {
  const double integral = 2. / 3 *
                          (3 * a * a * b * std::asinh(b / a) + 3 * a * b * b * std::asinh(a / b) + a * a * a +
                           b * b * b - std::pow(a * a + b * b, 1.5));
  return integral / (a * a * b * b);
}

// Into how many parts the sides of a face are cut, so that these are about as long as wide.
std::pair<int, int> cuts(double length_u, double length_v) {
  constexpr int kLeast = 2, kMost = 12;
  const double least = std::min(length_u, length_v);
  const auto n = [&](double length) {
    return std::clamp(2 * static_cast<int>(std::lround(kLeast * length / least / 2)), kLeast, kMost);
  };
  return {n(length_u), n(length_v)};
}

}  // namespace

HalfSpace::HalfSpace(const model::Surface& surface) : surface_(&surface), faces_(surface.node.size()) {
  for (Index f = 0; f < surface.face.cols(); ++f)
    for (int node : std::set<int>(surface.face.col(f).begin(), surface.face.col(f).end()))
      faces_[static_cast<std::size_t>(node)].push_back(static_cast<int>(f));
}

// The middles of equal parts of the faces around a node; a triangle is a quadrilateral with a side of no
// length.
const HalfSpace::Samples& HalfSpace::samples(int node) {
  const auto [at, is_new] = samples_.try_emplace(node);
  Samples& samples = at->second;
  if (!is_new) return samples;
  double linear = 0, even = 0;
  for (int f : faces_[static_cast<std::size_t>(node)]) {
    const Eigen::Matrix<double, 3, 4> X = surface_->X(Eigen::all, surface_->face.col(f));
    const Vector3d u = (X.col(1) - X.col(0) + X.col(2) - X.col(3)) / 2,
                   v = (X.col(3) - X.col(0) + X.col(2) - X.col(1)) / 2;
    const auto [n_u, n_v] = cuts(u.norm(), v.norm());
    for (int i = 0; i < n_u; ++i)
      for (int j = 0; j < n_v; ++j) {
        const contact::Shape shape = contact::shape(4, (2 * i + 1.0) / n_u - 1, (2 * j + 1.0) / n_v - 1);
        const Vector3d x_u = 2 * X * shape.N_u / n_u, x_v = 2 * X * shape.N_v / n_v;
        const double area = x_u.cross(x_v).norm();
        Index nearest = 0;
        shape.N.maxCoeff(&nearest);
        double N = 0;
        for (int c = 0; c < 4; ++c)
          if (surface_->face(c, f) == node) N += shape.N[c];
        samples.push_back({X * shape.N, N * area, surface_->face(nearest, f) == node ? area : 0,
                           mean_within(x_u.norm(), x_v.norm())});
        linear += samples.back().linear;
        even += samples.back().even;
      }
  }
  for (Sample& sample : samples) {
    sample.linear /= linear;
    sample.even /= even;
  }
  return samples;
}

double HalfSpace::integral(int i, int j) {
  constexpr double kFar = 16;  // squared distance over the squared size of a node's faces, where 1/r is right
  const Vector3d away = surface_->X.col(i) - surface_->X.col(j);
  const Samples &a = samples(i), &b = samples(j);
  double size = 0;
  for (const Sample& sample : a) size = std::max(size, (sample.x - surface_->X.col(i)).squaredNorm());
  for (const Sample& sample : b) size = std::max(size, (sample.x - surface_->X.col(j)).squaredNorm());
  if (away.squaredNorm() > kFar * size) return 1 / away.norm();
  const double touching = 1e-12 * size;  // squared distance of samples that are the same part of a face
  double sum = 0;
  for (const Sample& p : a)
    for (const Sample& q : b) {
      const double r2 = (p.x - q.x).squaredNorm();
      sum += (4 * p.even * q.even - 3 * p.linear * q.linear) *
             (r2 > touching ? 1 / std::sqrt(r2) : p.inverse_own);
    }
  return sum;
}

double HalfSpace::mean_inverse_distance(int i, int j) {
  if (i > j) std::swap(i, j);
  const auto n = static_cast<std::int64_t>(surface_->node.size());
  const auto [at, is_new] = known_.try_emplace(i * n + j, 0);
  if (is_new) at->second = integral(i, j);
  return at->second;
}

}  // namespace elastogear::dynamics
