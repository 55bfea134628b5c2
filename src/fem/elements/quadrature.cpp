#include "fem/elements/quadrature.h"

#include <cmath>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::fem {
namespace {

struct Point {
  Eigen::Vector3d xi;
  double w;
};
using Points = std::vector<Point>;

Rule rule(const Points& points) {
  Rule r{Eigen::Matrix3Xd(3, points.size()), Eigen::VectorXd(points.size())};
  for (std::size_t p = 0; p < points.size(); ++p) {
    r.xi.col(static_cast<Eigen::Index>(p)) = points[p].xi;
    r.w(static_cast<Eigen::Index>(p)) = points[p].w;
  }
  return r;
}

// Gauss points of [-1, 1] in the third coordinate.
Points line(int n) {
  if (n == 2) return {{{0, 0, -1 / std::sqrt(3.0)}, 1}, {{0, 0, 1 / std::sqrt(3.0)}, 1}};
  require(n == 3, "no Gauss rule with ", n, " points on a line, allowed are 2 and 3");
  return {{{0, 0, -std::sqrt(0.6)}, 5.0 / 9}, {{0, 0, 0}, 8.0 / 9}, {{0, 0, std::sqrt(0.6)}, 5.0 / 9}};
}

// The three points (a, a), (1 - 2a, a), (a, 1 - 2a), which together weigh `sum` of the triangle's area 1/2.
void add_triangle_orbit(Points& points, double a, double sum) {
  for (const auto& [x, y] : {std::pair{a, a}, {1 - 2 * a, a}, {a, 1 - 2 * a}})
    points.push_back({{x, y, 0}, sum / 6});
}

Points triangle(int n) {
  if (n == 1) return {{{1.0 / 3, 1.0 / 3, 0}, 0.5}};
  Points points;
  if (n == 3) add_triangle_orbit(points, 1.0 / 6, 1);
  if (n == 6)
    for (int sign : {1, -1}) {
      const double a = (8 - std::sqrt(10.0) + sign * std::sqrt(38 - 44 * std::sqrt(0.4))) / 18;
      add_triangle_orbit(points, a, (620 + sign * std::sqrt(213125 - 53320 * std::sqrt(10.0))) / 1240);
    }
  require(!points.empty(), "no triangle rule with ", n, " points, allowed are 1, 3 and 6");
  return points;
}

// The four points with barycentric coordinates a, a, a, 1 - 3a.
void add_vertex_orbit(Points& points, double a, double w) {
  points.push_back({Eigen::Vector3d::Constant(a), w});
  for (int k = 0; k < 3; ++k)
    points.push_back({Eigen::Vector3d::Constant(a) + (1 - 4 * a) * Eigen::Vector3d::Unit(k), w});
}

// The six points with barycentric coordinates b, b, 1/2 - b, 1/2 - b.
void add_edge_orbit(Points& points, double b, double w) {
  const double c = 0.5 - b;
  for (int k = 0; k < 3; ++k) {
    points.push_back({Eigen::Vector3d::Constant(b) + (c - b) * Eigen::Vector3d::Unit(k), w});
    points.push_back({Eigen::Vector3d::Constant(c) + (b - c) * Eigen::Vector3d::Unit(k), w});
  }
}

}  // namespace

Rule hexahedron_rule(int n) {
  Points points;
  for (const Point& z : line(n))
    for (const Point& y : line(n))
      for (const Point& x : line(n)) points.push_back({{x.xi.z(), y.xi.z(), z.xi.z()}, x.w * y.w * z.w});
  return rule(points);
}

Rule tetrahedron_rule(int n_points) {
  Points points;
  if (n_points == 1) points.push_back({Eigen::Vector3d::Constant(0.25), 1.0 / 6});
  if (n_points == 4) add_vertex_orbit(points, (5 - std::sqrt(5.0)) / 20, 1.0 / 24);
  if (n_points == 15) {
    const double r = std::sqrt(15.0);
    points.push_back({Eigen::Vector3d::Constant(0.25), 8.0 / 405});
    add_vertex_orbit(points, (7 + r) / 34, (2665 - 14 * r) / 226800);
    add_vertex_orbit(points, (7 - r) / 34, (2665 + 14 * r) / 226800);
    add_edge_orbit(points, (5 - r) / 20, 5.0 / 567);
  }
  require(!points.empty(), "no tetrahedron rule with ", n_points, " points, allowed are 1, 4 and 15");
  return rule(points);
}

Rule wedge_rule(int n_triangle, int n_line) {
  Points points;
  for (const Point& z : line(n_line))
    for (const Point& t : triangle(n_triangle)) points.push_back({t.xi + z.xi, t.w * z.w});
  return rule(points);
}

}  // namespace elastogear::fem
