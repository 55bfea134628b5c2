#include "contact/projection/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/projection/roots.h"

namespace elastogear::contact {
namespace {

// x(u, v) - q = (c + a u) + (b + t u) v
struct Bilinear {
  Eigen::Vector3d c, a, b, t;
};

Bilinear bilinear(const Face& face, const Eigen::Vector3d& q) {
  const auto& x = face.x;
  if (face.sides == 3) return {x[0] - q, x[1] - x[0], x[2] - x[0], Eigen::Vector3d::Zero()};
  const Eigen::Vector3d low = x[0] + x[1], high = x[3] + x[2], along_low = x[1] - x[0],
                        along_high = x[2] - x[3];
  return {0.25 * (low + high) - q, 0.25 * (along_low + along_high), 0.25 * (high - low),
          0.25 * (along_high - along_low)};
}

// Half the gradient and Hessian of |q - x(u, v)|^2.
struct Derivatives {
  double g_u, g_v, h_uu, h_vv, h_uv;
};

Derivatives derivatives(const Bilinear& x, const Eigen::Vector2d& at, bool full) {
  const Eigen::Vector3d a_u = x.a + at[1] * x.t, a_v = x.b + at[0] * x.t, d = x.c + at[0] * x.a + at[1] * a_v;
  const double curvature = full ? d.dot(x.t) : 0;
  return {d.dot(a_u), d.dot(a_v), a_u.squaredNorm(), a_v.squaredNorm(), a_u.dot(a_v) + curvature};
}

// Newton's step; false when the Hessian is not safely positive definite.
bool step(const Derivatives& f, Eigen::Vector2d& delta) {
  const double det = f.h_uu * f.h_vv - f.h_uv * f.h_uv, singular = 1e-12;
  if (!(det > singular * f.h_uu * f.h_vv)) return false;
  delta = {(f.h_uv * f.g_v - f.h_vv * f.g_u) / det, (f.h_uv * f.g_u - f.h_uu * f.g_v) / det};
  return true;
}

constexpr int kGaussNewtonSteps = 3, kSteps = 25;
constexpr double kConverged = 1e-13, kConvergedQuadratically = 1e-9;
constexpr double kDivergence = 3;  // local coordinates beyond which the foot point cannot return to the face

// Foot point from a start: Gauss-Newton steps first, then full Newton. Where
// the full Hessian is indefinite, Gauss-Newton goes on: only it descends there. docs/theory, Eq. (6.2).
bool foot_point(const Bilinear& x, Eigen::Vector2d& at) {
  for (int i = 0; i < kSteps; ++i) {
    Eigen::Vector2d delta;
    const bool full = i >= kGaussNewtonSteps;
    if (!step(derivatives(x, at, full), delta) && !(full && step(derivatives(x, at, false), delta)))
      return false;
    delta *= std::min(1.0, 1 / delta.cwiseAbs().maxCoeff());
    at += delta;
    if (at.cwiseAbs().maxCoeff() > kDivergence) return false;
    if (delta.cwiseAbs().maxCoeff() < (full ? kConvergedQuadratically : kConverged)) return true;
  }
  return false;
}

ClosestPoint point_at(const Face& face, const Eigen::Vector3d& q, Feature feature, int part,
                      const Eigen::Vector2d& at) {
  ClosestPoint p{feature, part, at[0], at[1], shape(face.sides, at[0], at[1]).N};
  p.x = combine(face, p.N);
  p.distance2 = (q - p.x).squaredNorm();
  return p;
}

void try_interior(const Face& face, const Bilinear& x, const Eigen::Vector3d& q, Eigen::Vector2d start,
                  ClosestPoint& best) {
  if (!foot_point(x, start) || !inside(face, start[0], start[1])) return;
  const ClosestPoint p = point_at(face, q, Feature::face, 0, start);
  if (p.distance2 < best.distance2) best = p;
}

// Parameter of the point closest to q on the line a-b, unbounded; the same from both ends.
double line_parameter(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& q) {
  const Eigen::Vector3d e = b - a;
  const double length2 = e.squaredNorm();
  return length2 > 0 ? (q - a).dot(e) / length2 : 0;
}

bool in_order(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

ClosestPoint on_open_side(const Face& face, const Eigen::Vector3d& q, int side) {
  const Eigen::Vector2d a = extended_corner(face, side), b = extended_corner(face, (side + 1) % face.sides);
  const auto at = [&](const Eigen::Vector2d& p) { return combine(face, shape(face.sides, p[0], p[1]).N); };
  const double s = std::clamp(line_parameter(at(a), at(b), q), 0.0, 1.0);
  return point_at(face, q, Feature::outside, side, (1 - s) * a + s * b);
}

// Offers the closest point of a side that may be shared.
void try_shared_side(const Face& face, const Eigen::Vector3d& q, int side, ClosestPoint& best) {
  const int next = (side + 1) % face.sides, previous = (side + face.sides - 1) % face.sides;
  const bool forward = in_order(face.x[side], face.x[next]);
  const int first = forward ? side : next, last = forward ? next : side;
  const Eigen::Vector3d &a = face.x[first], &b = face.x[last];
  const double lo = -face.extension[forward ? previous : next];
  const double hi = 1 + face.extension[forward ? next : previous];
  const double s = std::clamp(line_parameter(a, b, q), lo, hi);
  const Eigen::Vector3d x = s == 0 ? a : s == 1 ? b : Eigen::Vector3d((1 - s) * a + s * b);
  const double distance2 = (q - x).squaredNorm();
  if (!(distance2 < best.distance2)) return;

  best = {Feature::edge, side};
  if (s == lo || s == hi || a == b) best.feature = s == 0 || s == 1 ? Feature::vertex : Feature::outside;
  if (best.feature == Feature::vertex) best.part = s == 0 ? first : last;
  const Eigen::Vector2d local = on_side(face.sides, side, forward ? s : 1 - s);
  best.u = local[0], best.v = local[1];
  best.N[first] = 1 - s;
  best.N[last] = s;
  best.x = x;
  best.distance2 = distance2;
}

void try_sides(const Face& face, const Eigen::Vector3d& q, ClosestPoint& best) {
  for (int side = 0; side < face.sides; ++side) {
    if (face.extension[side] == 0) {
      try_shared_side(face, q, side, best);
    } else if (const ClosestPoint p = on_open_side(face, q, side); p.distance2 < best.distance2) {
      best = p;
    }
  }
}

// A face whose twist is not small against the heights of its parallelogram may have several foot points.
bool is_irregular(const Bilinear& x) {
  constexpr double kModerate = 0.25;
  const double longer2 = std::max(x.a.squaredNorm(), x.b.squaredNorm());
  return !(x.t.squaredNorm() * longer2 < kModerate * kModerate * x.a.cross(x.b).squaredNorm());
}

// The distance from q to the line of constant u, squared, is |n|^2 / m with n = (c + a u) x (b + t u) and m =
// |b + t u|^2. The coefficients of m d|n|^2/du - |n|^2 dm/du, by ascending powers of u.
// docs/theory, Eq. (6.2a).
std::vector<double> slope_of_distance(const Bilinear& x) {
  const Eigen::Vector3d n[3] = {x.c.cross(x.b), x.c.cross(x.t) + x.a.cross(x.b), x.a.cross(x.t)};
  const double m[3] = {x.b.squaredNorm(), 2 * x.b.dot(x.t), x.t.squaredNorm()};
  double n2[5] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) n2[i + j] += n[i].dot(n[j]);
  std::vector<double> slope(6, 0);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j) slope[i + j - 1] += (i - j) * n2[i] * m[j];
  return slope;
}

// All foot points of a quadrilateral.
void try_all_foot_points(const Face& face, const Bilinear& x, const Eigen::Vector3d& q, ClosestPoint& best) {
  const auto& e = face.extension;
  for (double u : sign_changes(slope_of_distance(x), -1 - 2 * e[3], 1 + 2 * e[1])) {
    const Eigen::Vector3d along = x.b + u * x.t;
    const double v = -along.dot(x.c + u * x.a) / along.squaredNorm();
    if (!inside(face, u, v)) continue;
    const ClosestPoint p = point_at(face, q, Feature::face, 0, {u, v});
    if (p.distance2 < best.distance2) best = p;
    try_interior(face, x, q, {u, v}, best);
  }
}

}  // namespace

bool is_farther(const Face& face, const Eigen::Vector3d& q, double distance) {
  if (face.sides == 3) return false;
  const Bilinear x = bilinear(face, q);
  Eigen::Vector2d foot;
  if (!step(derivatives(x, Eigen::Vector2d::Zero(), false), foot)) return false;
  const auto way = [&](double u, double v) -> Eigen::Vector3d { return x.c + u * x.a + v * (x.b + u * x.t); };
  const auto& e = face.extension;
  const double u[2] = {-1 - 2 * e[3], 1 + 2 * e[1]}, v[2] = {-1 - 2 * e[0], 1 + 2 * e[2]};
  const Eigen::Vector3d to_face = way(std::clamp(foot[0], u[0], u[1]), std::clamp(foot[1], v[0], v[1]));
  double least = std::numeric_limits<double>::infinity();
  for (double u_i : u)
    for (double v_j : v) least = std::min(least, to_face.dot(way(u_i, v_j)));
  return least > distance * to_face.norm();
}

ClosestPoint closest_point(const Face& face, const Eigen::Vector3d& q) {
  const Bilinear x = bilinear(face, q);
  ClosestPoint best;
  best.distance2 = std::numeric_limits<double>::infinity();
  if (face.sides == 3) {
    try_interior(face, x, q, Eigen::Vector2d::Constant(1.0 / 3), best);
    if (best.feature != Feature::face) try_sides(face, q, best);
    return best;
  }
  try_interior(face, x, q, Eigen::Vector2d::Zero(), best);
  const bool irregular = is_irregular(x);
  if (best.feature == Feature::face && !irregular) return best;
  if (irregular) try_all_foot_points(face, x, q, best);
  try_sides(face, q, best);
  return best;
}

}  // namespace elastogear::contact
