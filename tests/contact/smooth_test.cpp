// The smooth surface behind facets: its height, and the contact forces on it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>

#include "contact/projection/heights.h"
#include "contact/projection/smoothing.h"
#include "elastogear/contact/pair.h"
#include "surfaces.h"

namespace elastogear::contact::smooth_test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 1, kDepth = 1e-4, kSpan = 1.2;  // m, m, rad

// Part of a cylinder around y, seen from outside (side = 1) or inside (-1).
model::Surface cylinder(int facets, double side) {
  const model::Surface s = test::grid(facets, 3, [](double u, double v) {
    const double phi = kSpan * (u - 0.5);
    return Vector3d(kRadius * std::sin(phi), v - 0.5, kRadius * std::cos(phi));
  });
  return side < 0 ? test::flipped(s) : s;
}

SurfaceView view(const model::Surface& s, const Topology& map) { return {s.face, map, s.X, 0}; }

double radians(double degrees) { return degrees * test::pi / 180; }

double height_error(const model::Surface& s, int facets) {
  const Topology map = topology(s.face, int(s.X.cols()));
  const Heights heights = make_heights(view(s, map), ContactSurface::smooth, radians(30), {});
  double error = 0;
  for (int f = 0; f < s.face.cols(); ++f) {
    const Face face = face_of(view(s, map), f);
    const Vector3d centre = combine(face, shape(face.sides, 0.2, 0.2).N);
    const double phi = std::abs(std::atan2(centre.x(), centre.z()));
    if (phi > 0.5 * kSpan - 1.2 * kSpan / facets) continue;  // at free boundaries the normals are one-sided
    for (double t : {0.2, 0.4, 0.7}) {
      const double u = face.sides == 4 ? 2 * t - 1 : t / 2, v = face.sides == 4 ? 0.3 : t / 3;
      const Vector3d x = combine(face, shape(face.sides, u, v).N);
      const Vector3d smooth = x + height(heights, face.sides, f, u, v).f * normal(face, u, v);
      error = std::max(error, std::abs(std::hypot(smooth.x(), smooth.z()) - kRadius));
    }
  }
  return error;
}

TEST(Smoothing, closes_the_gap_between_facets_and_a_cylinder_with_the_fourth_order) {
  for (double side : {1.0, -1.0})
    for (bool triangles : {false, true}) {
      double error[3];
      for (int i = 0, n = 8; i < 3; ++i, n *= 2) {
        const model::Surface quads = cylinder(n, side);
        error[i] = height_error(triangles ? test::triangulated(quads) : quads, n);
        const double sagitta = kRadius * (1 - std::cos(0.5 * kSpan / n));
        EXPECT_LT(error[i], (triangles ? 0.5 : 0.02) * sagitta) << side << triangles << n;
      }
      if (!triangles) {
        EXPECT_GT(error[1] / error[2], 12);
      }
    }
}

TEST(Smoothing, keeps_creases_and_planes_as_they_are) {
  const model::Surface ridges = test::grid(6, 3, [](double u, double v) {
    return Vector3d(6 * u, v, std::lround(6 * u) % 2 ? 0.5 : 0.0);  // 53 deg between faces
  });
  const Topology map = topology(ridges.face, int(ridges.X.cols()));
  for (const CornerSlopes& s : corner_slopes(view(ridges, map), radians(30))) EXPECT_LT(s.norm(), 1e-14);
  double largest = 0;
  for (const CornerSlopes& s : corner_slopes(view(ridges, map), radians(60)))
    largest = std::max(largest, s.norm());
  EXPECT_GT(largest, 0.1);
}

struct Signal {
  double ripple = 0;  // (max - min) / mean of the force
  double turn = 0;    // rad, largest between the force and the cylinder's normal
  double jump = 0;    // rad, largest change of that between two positions 1/200 of a facet apart
};

const model::Surface& punch() {
  static const model::Surface surface = test::flipped(test::plane(1, 1, 1e-8, 1e-8));
  return surface;
}

Settings on_cylinder(bool smooth) {
  Settings s;
  s.stiffness = 1;
  s.penalty = Penalty::per_node;
  s.depth = 0.05;
  s.surface = smooth ? ContactSurface::smooth : ContactSurface::facets;
  return s;
}

// The punch of one face beside the cylinder's edge at phi = 0.
SurfaceState punch_at(double phi, double side, double depth) {
  const Vector3d radial(std::sin(phi), 0, std::cos(phi));
  SurfaceState state = test::at(punch(), (kRadius - side * depth) * radial, {0, phi, 0});
  if (side < 0) state.R_WB = state.R_WB * test::rotation({test::pi, 0, 0});
  return state;
}

// The punch is led along the cylinder at constant depth.
Signal slide(int facets, double side, bool smooth) {
  const model::Surface master = cylinder(facets, side);
  Pair pair(punch(), master, on_cylinder(smooth));
  const double theta = kSpan / facets;
  double smallest = 1e9, largest = 0, sum = 0, before = NAN;
  int n = 0;
  Signal signal;
  for (double phi = -1.5 * theta; phi < 1.5 * theta; phi += theta / 200, ++n) {
    const Vector3d radial(std::sin(phi), 0, std::cos(phi)), normal = side * radial;
    const auto contacts = pair.detect(punch_at(phi, side, kDepth), test::at(master));
    double force = 0;
    Vector3d direction = Vector3d::Zero();
    for (const ContactPoint& c : contacts) force += c.f.norm(), direction += c.f;
    if (contacts.empty()) direction = normal;
    const double angle = std::asin(direction.normalized().cross(normal).y());
    smallest = std::min(smallest, force), largest = std::max(largest, force), sum += force;
    signal.turn = std::max(signal.turn, std::abs(angle));
    if (n > 0) signal.jump = std::max(signal.jump, std::abs(angle - before));
    before = angle;
  }
  signal.ripple = (largest - smallest) * n / sum;
  return signal;
}

TEST(SmoothNormals, take_jumps_and_ripple_out_of_sliding_over_facets) {
  constexpr int facets = 24;
  const double theta = kSpan / facets;
  for (double side : {1.0, -1.0}) {
    const Signal plain = slide(facets, side, false), smooth = slide(facets, side, true);
    std::printf(
        "%s: ripple on facets %.0f %%, on the smooth surface %.2g %%; its turn %.2g %% of a facet's\n",
        side > 0 ? "outside" : "inside", 100 * plain.ripple, 100 * smooth.ripple, 100 * smooth.turn / theta);
    EXPECT_GT(plain.ripple, 1) << "the sagitta is three times the depth";
    EXPECT_LT(smooth.ripple, 0.003);
    EXPECT_LT(smooth.turn, 0.0005 * theta);
    EXPECT_LT(smooth.jump, 0.0005 * theta);
    if (side < 0) {
      EXPECT_GT(plain.turn, 0.45 * theta) << "inside, where facets stand before the cylinder";
    }
  }
}

// Otherwise a node whose residual displacement pushes it from each face to the other has no solution.
TEST(SmoothNormals, a_node_hardly_past_an_edge_stays_on_its_face) {
  constexpr int facets = 24;
  const double theta = kSpan / facets, hardly = 1e-5 * theta, far = 1e-2 * theta, depth = 0.01 * kDepth;
  for (double side : {1.0, -1.0}) {
    const model::Surface master = cylinder(facets, side);
    Pair smooth(punch(), master, on_cylinder(true));
    const auto found = [&](Pair& pair, double phi) {
      return pair.detect(punch_at(phi, side, depth), test::at(master)).front();
    };
    const ContactPoint a = found(smooth, -far), kept = found(smooth, hardly), b = found(smooth, far);
    EXPECT_EQ(kept.face, a.face);
    EXPECT_NE(b.face, a.face);
    EXPECT_EQ(found(smooth, -hardly).face, b.face);
    Pair fresh(punch(), master, on_cylinder(true));
    const ContactPoint anew = found(fresh, hardly);
    EXPECT_EQ(anew.face, b.face);
    EXPECT_NEAR(kept.g_n, anew.g_n, 1e-4 * depth);
    EXPECT_LT((kept.n - anew.n).norm(), 1e-3 * theta);
  }
}

}  // namespace
}  // namespace elastogear::contact::smooth_test
