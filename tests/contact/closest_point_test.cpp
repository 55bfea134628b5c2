#include "contact/projection/closest_point.h"

#include <gtest/gtest.h>

#include "surfaces.h"

namespace elastogear::contact::closest_point_test {
namespace {

using test::Random;

Face random_face(Random& random, double warp) {
  Face face;
  const double x[4] = {-1, 1, 1, -1}, y[4] = {-1, -1, 1, 1};
  const Eigen::Matrix3d A =
      test::rotation(random.vector(3)) * Eigen::Vector3d(random.uniform(0.3, 2), 1, 1).asDiagonal();
  for (int i = 0; i < 4; ++i) face.x[i] = A * (Eigen::Vector3d(x[i], y[i], 0) + random.vector(warp));
  return face;
}

Face random_triangle(Random& random) {
  Face face;
  face.sides = 3;
  for (int i = 0; i < 3; ++i) face.x[i] = random.vector(1);
  face.x[3] = face.x[2];
  return face;
}

Eigen::Vector3d point(const Face& face, double u, double v) {
  return combine(face, shape(face.sides, u, v).N);
}

// Least distance over a fine grid of the face, including its boundary.
double sampled_distance(const Face& face, const Eigen::Vector3d& q, int n = 100) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= (face.sides == 4 ? n : n - i); ++j) {
      const double a = double(i) / n, b = double(j) / n;
      const Eigen::Vector3d x = face.sides == 4 ? point(face, 2 * a - 1, 2 * b - 1) : point(face, a, b);
      least = std::min(least, (q - x).norm());
    }
  return least;
}

// On the face, consistent with its own fields, and no sample is nearer.
void expect_closest(const Face& face, const Eigen::Vector3d& q) {
  const ClosestPoint p = closest_point(face, q);
  ASSERT_TRUE(p.x.allFinite() && p.N.allFinite() && std::isfinite(p.u) && std::isfinite(p.v));
  EXPECT_TRUE(inside(face, p.u, p.v) || p.feature != Feature::face);
  EXPECT_NEAR((combine(face, p.N) - p.x).norm(), 0, 1e-14 * (1 + p.x.norm()));
  EXPECT_NEAR((point(face, p.u, p.v) - p.x).norm(), 0, 1e-13 * (1 + p.x.norm()));
  EXPECT_LE(std::sqrt(p.distance2), sampled_distance(face, q) * (1 + 1e-12));
}

TEST(ClosestPoint, equals_brute_force_sampling_on_smooth_and_warped_quadrilaterals) {
  Random random(1);
  for (double warp : {0.0, 0.1, 0.5, 0.9, 1.5, 2.5})
    for (int trial = 0; trial < 300; ++trial) {
      const Face face = random_face(random, warp);
      expect_closest(face, random.vector(trial % 3 == 0 ? 5 : 1.5));
      if (HasFailure()) FAIL() << "warp " << warp << ", trial " << trial;
    }
}

TEST(ClosestPoint, equals_brute_force_sampling_on_triangles) {
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) expect_closest(random_triangle(random), random.vector(2));
}

TEST(ClosestPoint, is_finite_and_closest_on_degenerate_faces) {
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    Face face = trial % 2 ? random_face(random, 0.2) : random_triangle(random);
    switch (trial % 5) {
      case 0:
        face.x[1] = face.x[0];
        break;  // a side of no length
      case 1:
        for (auto& x : face.x) x = face.x[0];
        break;  // a point
      case 2:
        for (int i = 0; i < 4; ++i) face.x[i] = i * face.x[0];
        break;  // a line
      case 3:
        std::swap(face.x[0], face.x[1]);
        break;  // crossed
      case 4:
        face.x[2] = 0.5 * (face.x[1] + face.x[3]) + random.vector(1e-9);
        break;  // a flat corner
    }
    expect_closest(face, random.vector(2));
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(ClosestPoint, inside_a_face_is_its_foot_point) {
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const Face face = random_face(random, 0.2);
    const double u = random.uniform(-0.95, 0.95), v = random.uniform(-0.95, 0.95),
                 g = random.uniform(-0.05, 0.05);
    const ClosestPoint p = closest_point(face, point(face, u, v) + g * normal(face, u, v));
    ASSERT_EQ(p.feature, Feature::face);
    EXPECT_NEAR(p.u, u, 1e-12);
    EXPECT_NEAR(p.v, v, 1e-12);
    EXPECT_NEAR(std::sqrt(p.distance2), std::abs(g), 1e-13);
  }
}

TEST(ClosestPoint, is_found_far_from_the_origin) {
  Random random(5);
  for (int trial = 0; trial < 100; ++trial) {
    Face face = random_face(random, 0.1);
    const Eigen::Vector3d shift = random.vector(1e4);
    for (auto& x : face.x) x += shift;
    const ClosestPoint p = closest_point(face, point(face, 0.3, -0.4) + 0.01 * normal(face, 0.3, -0.4));
    EXPECT_EQ(p.feature, Feature::face);
    EXPECT_NEAR(p.u, 0.3, 1e-9);
  }
}

TEST(ClosestPoint, clamping_the_foot_point_would_not_do_on_a_skew_face) {
  Face skew;
  skew.x = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(2, 1, 0),
            Eigen::Vector3d(1, 1, 0)};
  const Eigen::Vector3d q(0.3, 0.7, 0);  // xi, eta = (-1.8, 0.4): clamped (-1, 0.4) is (0.7, 0.7)
  const ClosestPoint p = closest_point(skew, q);
  EXPECT_EQ(p.feature, Feature::edge);
  EXPECT_NEAR((p.x - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 0, 1e-14);
}

TEST(ClosestPoint, on_a_shared_side_or_corner_is_bitwise_the_same_from_both_faces) {
  Random random(6);
  for (int trial = 0; trial < 300; ++trial) {
    const Face left = random_face(random, 0.2);
    Face right = random_face(random, 0.2);
    right.x[0] = left.x[1], right.x[3] = left.x[2];
    const Eigen::Vector3d q =
        left.x[1] + random.uniform(-0.3, 1.3) * (left.x[2] - left.x[1]) + random.vector(0.05);
    const ClosestPoint a = closest_point(left, q), b = closest_point(right, q);
    if (a.feature == Feature::face || b.feature == Feature::face) continue;
    if (a.feature == Feature::edge && (a.part != 1 || b.part != 3)) continue;
    if (b.feature != a.feature) continue;
    if (a.feature == Feature::vertex && a.part != 1 && a.part != 2) continue;
    EXPECT_EQ(a.distance2, b.distance2);
  }
}

TEST(ClosestPoint, on_an_open_side_reaches_as_far_as_the_extension) {
  for (int sides : {3, 4}) {
    Face face;
    face.sides = sides;
    face.x = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0),
              Eigen::Vector3d(0, 1, 0)};
    face.extension[0] = 0.1;  // the side at y = 0
    EXPECT_EQ(closest_point(face, {0.7, -0.09, 1}).feature, Feature::face);
    EXPECT_EQ(closest_point(face, {0.7, -0.11, 1}).feature, Feature::outside);
    EXPECT_NEAR(std::sqrt(closest_point(face, {0.7, -0.11, 0}).distance2), 0.01, 1e-14);
    EXPECT_EQ(closest_point(face, {1.01, -0.05, 1}).feature, Feature::edge) << "the prolonged shared side";
    EXPECT_EQ(closest_point(face, {1.01, -0.11, 1}).feature, Feature::outside);
    EXPECT_EQ(closest_point(face, {1.01, 0.5, 1}).feature, Feature::edge);
    EXPECT_EQ(closest_point(face, {1.2, 1.1, 1}).feature, Feature::vertex);
  }
}

// A plane between both tells nothing but what holds.
TEST(ClosestPoint, is_no_nearer_than_a_face_is_told_to_be) {
  Random random(9);
  int n_told = 0, n_near = 0;
  for (double warp : {0.0, 0.1, 0.5, 1.5})
    for (int trial = 0; trial < 500; ++trial) {
      Face face = trial % 5 == 0 ? random_triangle(random) : random_face(random, warp);
      for (double& e : face.extension) e = trial % 3 == 0 ? random.uniform(0, 0.3) : 0;
      const Eigen::Vector3d q = random.vector(trial % 2 == 0 ? 5 : 1.5);
      const double distance = std::sqrt(closest_point(face, q).distance2);
      n_told += is_farther(face, q, 0.9 * distance);
      n_near += is_farther(face, q, (1 + 1e-12) * distance);
    }
  EXPECT_EQ(n_near, 0);
  EXPECT_GT(n_told, 1000) << "of 1600 quadrilaterals";
}

TEST(ClosestPoint, of_a_plane_rectangle_is_as_far_as_the_face_is_told_to_be) {
  Face face;
  face.x = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(3, 2, 0),
            Eigen::Vector3d(0, 2, 0)};
  face.extension[1] = 0.2;  // until x = 3.6
  for (const Eigen::Vector3d& q : {Eigen::Vector3d(1, 1, 0.5), Eigen::Vector3d(4, 1, 0.5),
                                   Eigen::Vector3d(-2, -1, 0.1), Eigen::Vector3d(1, 7, -2)}) {
    const double distance = std::sqrt(closest_point(face, q).distance2);
    EXPECT_TRUE(is_farther(face, q, (1 - 1e-12) * distance)) << q.transpose();
    EXPECT_FALSE(is_farther(face, q, (1 + 1e-12) * distance)) << q.transpose();
  }
}

TEST(Face, natural_coordinates_of_a_triangle_are_those_of_the_collapsed_quadrilateral) {
  Random random(7);
  const Face triangle = random_triangle(random);
  Face collapsed = triangle;
  collapsed.sides = 4;
  for (const auto& [u, v] : {std::pair{0.2, 0.3}, {0.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}}) {
    const Eigen::Vector2d natural = natural_coordinates(3, u, v);
    EXPECT_NEAR((point(triangle, u, v) - point(collapsed, natural[0], natural[1])).norm(), 0, 1e-15);
  }
}

}  // namespace
}  // namespace elastogear::contact::closest_point_test
