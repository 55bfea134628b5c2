#include "contact/faces/overlap.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastogear::contact {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kSliver = 1e-14;  // of the slave face's area, that two faces share by roundoff
constexpr int kMostCorners = 8;    // of the part that two quadrilaterals share

struct Polygon {
  std::array<Vector2d, kMostCorners> x;
  int n = 0;
  void add(const Vector2d& corner) {
    if (n < kMostCorners) x[n++] = corner;
  }
};

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// The part of a polygon to the left of the line from a to b: I. E. Sutherland, G. W. Hodgman, Comm. ACM 17
// (1974) 32-42.
Polygon left_of(const Polygon& polygon, const Vector2d& a, const Vector2d& b) {
  Polygon part;
  for (int i = 0; i < polygon.n; ++i) {
    const Vector2d &from = polygon.x[i], &to = polygon.x[(i + 1) % polygon.n];
    const double d_from = cross(b - a, from - a), d_to = cross(b - a, to - a);
    if (d_from >= 0) part.add(from);
    if ((d_from < 0) != (d_to < 0)) part.add(from + d_from / (d_from - d_to) * (to - from));
  }
  return part;
}

double twice_area(const Polygon& p) {
  double sum = 0;
  for (int i = 2; i < p.n; ++i) sum += cross(p.x[i - 1] - p.x[0], p.x[i] - p.x[0]);
  return sum;
}

// A rule of six points on the triangle, exact for degree four: D. A. Dunavant, Int. J. Numer. Meth. Eng. 21
// (1985) 1129-1148. Weights sum to one.
struct TrianglePoint {
  double l[3], weight;
};
const std::array<TrianglePoint, 6>& triangle_rule() {
  static const std::array<TrianglePoint, 6> rule = [] {
    const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), w = std::sqrt(213125 - 53320 * std::sqrt(10.0));
    const double a[2] = {(8 - std::sqrt(10.0) + root) / 18, (8 - std::sqrt(10.0) - root) / 18},
                 weight[2] = {(620 + w) / 3720, (620 - w) / 3720};
    std::array<TrianglePoint, 6> points{};
    for (int i = 0; i < 6; ++i) {
      const double l = a[i / 3];
      points[i] = {{l, l, l}, weight[i / 3]};
      points[i].l[i % 3] = 1 - 2 * l;
    }
    return points;
  }();
  return rule;
}

// (u, v) of the point of the face over x, by Newton's method; exact at once on triangles and parallelograms.
Vector2d local_coordinates(const FacePlane& slave, const Vector2d& x) {
  constexpr int kMostSteps = 20;
  const int sides = slave.face.sides;
  Vector2d at = sides == 3 ? Vector2d(1. / 3, 1. / 3) : Vector2d(0, 0);
  for (int step = 0; step < kMostSteps; ++step) {
    const Shape s = shape(sides, at[0], at[1]);
    Vector2d rest = x;
    Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
    for (int i = 0; i < sides; ++i) {
      rest -= s.N[i] * slave.x[i];
      J.col(0) += s.N_u[i] * slave.x[i];
      J.col(1) += s.N_v[i] * slave.x[i];
    }
    const Vector2d change = J.inverse() * rest;
    at += change;
    if (!(change.cwiseAbs().maxCoeff() > 1e-14)) break;
  }
  return at;
}

// Area of the face over that on the plane.
double stretch(const FacePlane& slave, const Vector2d& at) {
  const Shape s = shape(slave.face.sides, at[0], at[1]);
  const Vector3d normal = combine(slave.face, s.N_u).cross(combine(slave.face, s.N_v));
  return normal.norm() / std::abs(normal.dot(slave.axes.row(2)));
}

void add_points(const FacePlane& slave, const Polygon& part, int master_face,
                std::vector<OverlapPoint>& points) {
  for (int i = 2; i < part.n; ++i) {
    const Vector2d &a = part.x[0], &b = part.x[i - 1], &c = part.x[i];
    const double area = 0.5 * cross(b - a, c - a);
    if (!(area > 0)) continue;
    for (const TrianglePoint& p : triangle_rule()) {
      const Vector2d at = local_coordinates(slave, p.l[0] * a + p.l[1] * b + p.l[2] * c);
      points.push_back({at, p.weight * area * stretch(slave, at), master_face});
    }
  }
}

}  // namespace

FacePlane face_plane(const Face& face) {
  const Vector2d centre = face.sides == 3 ? Vector2d(1. / 3, 1. / 3) : Vector2d(0, 0);
  FacePlane plane{face, combine(face, shape(face.sides, centre[0], centre[1]).N), {}, {}};
  const Vector3d n = normal(face, centre[0], centre[1]), e = n.unitOrthogonal();
  plane.axes << e.transpose(), n.cross(e).transpose(), n.transpose();
  for (int i = 0; i < face.sides; ++i) {
    const Vector3d x = plane.axes * (face.x[i] - plane.centre);
    plane.x[i] = x.head<2>();
    plane.lowest = std::min(plane.lowest, x.z());
    plane.highest = std::max(plane.highest, x.z());
  }
  return plane;
}

bool add_overlap(const FacePlane& slave, const Face& master, int master_face, const OverlapLimits& limits,
                 std::vector<OverlapPoint>& points) {
  const double middle = master.sides == 3 ? 1. / 3 : 0;
  if (!(normal(master, middle, middle).dot(slave.axes.row(2)) <= limits.cos_angle)) return false;
  Polygon part;
  for (int i = 0; i < slave.face.sides; ++i) part.add(slave.x[i]);
  const double all = twice_area(part);
  std::array<Vector2d, 4> x;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (int i = 0; i < master.sides; ++i) {
    const Vector3d y = slave.axes * (master.x[master.sides - 1 - i] - slave.centre);  // seen from the slave
    x[i] = y.head<2>();
    lowest = std::min(lowest, y.z());
    highest = std::max(highest, y.z());
  }
  if (lowest - slave.highest > limits.outside || slave.lowest - highest > limits.depth) return false;
  for (int i = 0; i < master.sides && part.n > 2; ++i) part = left_of(part, x[i], x[(i + 1) % master.sides]);
  if (!(twice_area(part) > kSliver * all)) return false;
  add_points(slave, part, master_face, points);
  return true;
}

}  // namespace elastogear::contact
