// The point where two flanks on axes that cross are nearest to each other: Newton's method in two variables.

#include "contact/stations/flank_gap.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastogear::contact {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kNewtonSteps = 60, kNewtonHalvings = 30;
constexpr double kFound = 1e-9;           // of the height of the flank, its place, from where it settles
constexpr double kGapRoundoff = 1e-12;    // of the height of the flank, of gaps
constexpr double kHessianStep = 1e-4;     // of the height of the flank
constexpr double kLeastCurvature = 1e-3;  // over the height of a flank, the least curvature, 1/m

Vector2d slope(const FlankGap& gap, const Vector2d& at) {
  return {gap.slope_v(at[0], at[1]), gap.slope_z(at[0], at[1])};
}

Matrix2d second_derivatives(const FlankGap& gap, const Vector2d& at) {
  const double h = kHessianStep * gap.height();
  Matrix2d H;
  for (int k : {0, 1}) {
    const Vector2d step = h * Vector2d::Unit(k);
    H.col(k) = (slope(gap, at + step) - slope(gap, at - step)) / (2 * h);
  }
  return (H + H.transpose()) / 2;
}

struct Bounds {
  Vector2d low, high;

  Vector2d clamped(const Vector2d& at) const { return at.cwiseMax(low).cwiseMin(high); }
  bool holds(int k, const Vector2d& at, const Vector2d& slope) const {
    return (at[k] <= low[k] && slope[k] > 0) || (at[k] >= high[k] && slope[k] < 0);
  }
};

// Newton's step among the coordinates that no bound holds; down the slope where the gap is not convex.
Vector2d newton_step(const FlankGap& gap, const Bounds& bounds, const Vector2d& at, const Vector2d& g) {
  Matrix2d H = second_derivatives(gap, at);
  Vector2d down = -g;
  for (int k : {0, 1})
    if (bounds.holds(k, at, g)) {
      H(0, 1) = H(1, 0) = 0;
      H(k, k) = 1;
      down[k] = 0;
    }
  const Eigen::LLT<Matrix2d> factor(H);
  if (factor.info() == Eigen::Success) return factor.solve(down);
  return down * gap.height() / std::max(down.norm(), 1e-300);
}

}  // namespace

NearestPlace nearest_point(const FlankPair& flanks, const FaceEnds& ends, const RelativePlacement& placement,
                           const Vector2d& start) {
  const FlankGap gap(flanks, placement, ends);
  const Bounds bounds{{gap.low(), gap.face().from}, {gap.high(), gap.face().to}};
  const double roundoff = kGapRoundoff * gap.height();
  Vector2d at = bounds.clamped(start);
  double here = gap.at(at[0], at[1]), last = gap.height();
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector2d g = slope(gap, at);
    Vector2d d = newton_step(gap, bounds, at, g), to = bounds.clamped(at + d);
    double there = gap.at(to[0], to[1]);
    for (int k = 0; k < kNewtonHalvings && there > here + roundoff; ++k) {
      d /= 2;
      to = bounds.clamped(at + d);
      there = gap.at(to[0], to[1]);
    }
    const double change = (to - at).cwiseAbs().maxCoeff();
    at = to;
    here = there;
    // Steps that are small and no longer shrink are roundoff of slopes.
    if (change <= kFound * gap.height() && (change == 0 || change > last / 2)) break;
    last = change;
  }
  return place_at(gap, {at[1], at[1]}, at[0]);
}

namespace {

// Orthonormal directions of a tangent plane.
using Tangents = Eigen::Matrix<double, 3, 2>;

// 1/m, of the flanks alone, by second differences over the distance h along the chart.
Matrix2d flank_curvature(const FlankGap& gap, const FlankPoint& point, const Tangents& T, double v, double z,
                         double h) {
  const double h_z = h / point.x_z.norm();
  const auto G = [&](double i, double j) { return gap.without_edges(v + i * h, z + j * h_z); };
  const double middle = G(0, 0);
  Matrix2d H;
  H(0, 0) = G(1, 0) + G(-1, 0) - 2 * middle;
  H(1, 1) = G(0, 1) + G(0, -1) - 2 * middle;
  H(0, 1) = H(1, 0) = (G(1, 1) + G(-1, -1) - G(1, -1) - G(-1, 1)) / 4;
  Tangents along;  // by which both steps move
  along << h * point.x_v, h_z * point.x_z;
  const Matrix2d inverse = (T.transpose() * along).inverse();
  return inverse.transpose() * H * inverse;
}

// 1/m, what rounded edges of one body add, over the distance h: second differences along the gradients of
// both coordinates of its chart, which are never negative. R: turns its frame to that of T.
Matrix2d edge_curvature(const FlankGap& gap, bool of_owner, const FlankPoint& point, const Eigen::Matrix3d& R,
                        const Tangents& T, double v, double z, double h) {
  const Eigen::Vector3d to_v = point.x_z.cross(point.n), to_z = point.n.cross(point.x_v);
  const Vector2d grad_v = T.transpose() * R * to_v / point.x_v.dot(to_v),
                 grad_z = T.transpose() * R * to_z / point.x_z.dot(to_z);
  const double h_v = h * grad_v.norm(), h_z = h * grad_z.norm();
  const auto e = [&](double at_v, double at_z) { return gap.taken(of_owner, at_v, at_z); };
  const double bend_v = (e(v + h_v, z) + e(v - h_v, z) - 2 * e(v, z)) / (h_v * h_v);
  const double bend_z = (e(v, z + h_z) + e(v, z - h_z) - 2 * e(v, z)) / (h_z * h_z);
  return bend_v * grad_v * grad_v.transpose() + bend_z * grad_z * grad_z.transpose();
}

}  // namespace

PrincipalCurvatures curvatures(const FlankPair& flanks, const FaceEnds& ends,
                               const RelativePlacement& placement, const NearestPlace& place, double h) {
  const FlankGap gap(flanks, placement, ends);
  const double z = place.face.centre(), v = std::max(place.v, 1.5 * h);  // involutes begin at 0
  const FlankPoint on_owner = flanks.owner->point(flanks.on_owner, v, z);
  const FlankPoint on_mate = flanks.mate->point(flanks.on_mate, place.mate_v, place.mate_z);
  Tangents T;
  T.col(1) = on_owner.x_z.normalized();
  T.col(0) = T.col(1).cross(on_owner.n);
  const Matrix2d K = flank_curvature(gap, on_owner, T, v, z, h) +
                     edge_curvature(gap, true, on_owner, Eigen::Matrix3d::Identity(), T, place.v, z, h) +
                     edge_curvature(gap, false, on_mate, placement.R, T, place.mate_v, place.mate_z, h);
  const Eigen::SelfAdjointEigenSolver<Matrix2d> axes(K);
  const double flattest = kLeastCurvature / gap.height();
  return {std::max(axes.eigenvalues()[0], flattest), std::max(axes.eigenvalues()[1], flattest)};
}

}  // namespace elastogear::contact
