// The orders of the smooth surface on surfaces with uneven spacing and boundaries.
#include <gtest/gtest.h>

#include <cstdio>

#include "../figures.h"
#include "contact/projection/heights.h"
#include "contact/projection/node_normals.h"
#include "surfaces.h"

namespace elastogear::contact::smooth_order_test {
namespace {

using Eigen::Vector3d;

// A point of the true surface, with the outward normal there and the signed distance of any point.
struct Reference {
  const char* name;
  std::function<Vector3d(double, double)> point;
  std::function<Vector3d(const Vector3d&)> normal;
  std::function<double(const Vector3d&)> distance;
};

// Spacing that varies by a factor of 3 and does not become even with more faces.
double uneven(double s, int n) {
  const double i = s * n;
  return (i + 0.3 * std::sin(2.3 * i)) / (n + 0.3 * std::sin(2.3 * n));
}

Reference cylinder() {
  return {"cylinder", [](double u, double v) { return Vector3d(std::sin(u), v, std::cos(u)); },
          [](const Vector3d& x) { return Vector3d(x.x(), 0, x.z()).normalized(); },
          [](const Vector3d& x) { return std::hypot(x.x(), x.z()) - 1; }};
}

Reference sphere() {
  return {"sphere",
          [](double u, double v) {
            return Vector3d(std::sin(u) * std::cos(v), std::sin(v), std::cos(u) * std::cos(v));
          },
          [](const Vector3d& x) { return x.normalized(); }, [](const Vector3d& x) { return x.norm() - 1; }};
}

// Involute of the unit circle, extruded: its curvature is 1/t at the roll angle t.
Reference involute() {
  const auto roll = [](const Vector3d& x) { return std::sqrt(x.x() * x.x() + x.z() * x.z() - 1); };
  return {"involute",
          [](double u, double v) {
            const double t = 1 + u;
            return Vector3d(std::cos(t) + t * std::sin(t), v, std::sin(t) - t * std::cos(t));
          },
          [=](const Vector3d& x) {
            const double t = std::atan2(x.z(), x.x()) + std::atan(roll(x));
            return Vector3d(std::sin(t), 0, -std::cos(t));
          },
          [=](const Vector3d& x) {
            return std::atan2(x.z(), x.x()) + std::atan(roll(x)) -
                   roll(x);  // the difference of two involutes
          }};
}

struct Errors {
  double height = 0, normal = 0;  // m, rad
};

Errors errors(const Reference& reference, int n, bool triangles) {
  model::Surface s = test::grid(
      n, n, [&](double u, double v) { return reference.point(uneven(u, n) - 0.5, uneven(v, n) - 0.5); });
  if (triangles) s = test::triangulated(s);
  const Topology map = topology(s.face, static_cast<int>(s.X.cols()));
  const SurfaceView view{s.face, map, s.X, 0};
  const double side = normal(face_of(view, 0), 0, 0).dot(reference.normal(s.X.col(0))) > 0 ? 1 : -1;
  const Heights heights = make_heights(view, ContactSurface::smooth, 0.6, {});
  const auto normals = corner_normals(view, 0.6);
  Errors e;
  for (int f = 0; f < s.face.cols(); ++f) {
    const Face face = face_of(view, f);
    for (int c = 0; c < face.sides; ++c)
      e.normal =
          std::max(e.normal, normals[f].col(c).cross(side * reference.normal(s.X.col(s.face(c, f)))).norm());
    for (double a : {0.1, 0.3, 0.5, 0.7, 0.9})
      for (double b : {0.1, 0.4, 0.8}) {
        const double u = face.sides == 4 ? 2 * a - 1 : a * (1 - b), v = face.sides == 4 ? 2 * b - 1 : b;
        const Vector3d x = combine(face, shape(face.sides, u, v).N) +
                           height(heights, face.sides, f, u, v).f * normal(face, u, v);
        e.height = std::max(e.height, std::abs(reference.distance(x)));
      }
  }
  return e;
}

// With averaged normals, which are one-sided at boundaries, the orders are 2 and 1.
TEST(SmoothOrder, of_heights_and_normals_holds_up_to_boundaries_and_with_uneven_spacing) {
  constexpr double kHeight = 2.8, kNormal = 2.6;
  const std::string kCase = "smooth surfaces of a cylinder, a sphere, an involute";
  for (const Reference& r : {cylinder(), sphere(), involute()})
    for (bool triangles : {false, true}) {
      const Errors coarse = errors(r, 8, triangles), fine = errors(r, 32, triangles);
      const double height = std::log2(coarse.height / fine.height) / 2,
                   normal = std::log2(coarse.normal / fine.normal) / 2;
      std::printf("%s, %s: height %.2g, %.2g m, order %.1f; normal %.2g, %.2g rad, order %.1f\n", r.name,
                  triangles ? "triangles" : "quadrilaterals", coarse.height, fine.height, height,
                  coarse.normal, fine.normal, normal);
      elastogear::test::figure_above({kCase, "order of height"}, height, kHeight);
      elastogear::test::figure_above({kCase, "order of normal"}, normal, kNormal);
      EXPECT_LT(fine.height, 2e-6) << r.name << triangles;  // averaged normals: 1.1e-4 to 2.3e-4
      EXPECT_LT(fine.normal, 2e-4) << r.name << triangles;  // averaged normals: 2e-2
    }
}

// Where nodes do not determine a fit, normals are averages; edges stay sharp in any case.
TEST(SmoothOrder, normals_on_edges_are_those_of_the_faces_beside_them) {
  const model::Surface folded = test::grid(2, 1, [](double u, double v) {
    return Vector3d(2 * u, v, u > 0.5 ? 1.0 : 0.0);  // 45 deg
  });
  const Topology map = topology(folded.face, static_cast<int>(folded.X.cols()));
  const SurfaceView view{folded.face, map, folded.X, 0};
  const auto sharp = corner_normals(view, 0.6), smooth = corner_normals(view, 0.9);
  for (int f : {0, 1})
    for (int c = 0; c < 4; ++c)
      EXPECT_LT((sharp[f].col(c) - normal(face_of(view, f), 0, 0)).norm(), 1e-14) << f << c;
  EXPECT_GT((smooth[0].col(1) - normal(face_of(view, 0), 0, 0)).norm(), 0.1);
}

}  // namespace
}  // namespace elastogear::contact::smooth_order_test
