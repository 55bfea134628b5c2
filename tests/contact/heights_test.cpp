// Polynomial heights over faces: what they interpolate, their derivatives and bounds, and deviations.
#include "contact/projection/heights.h"

#include <gtest/gtest.h>

#include "elastogear/base/error.h"
#include "surfaces.h"

namespace elastogear::contact::heights_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRoundoff = 1e-12;

model::Surface one_face(int sides) {
  const model::Surface quad = test::plane(1, 1);
  return sides == 4 ? quad : test::triangulated(quad);
}

Heights exact(const model::Surface& s, const TrueSurface& known) {
  const Topology map = topology(s.face, static_cast<int>(s.X.cols()));
  return make_heights({s.face, map, s.X, 0}, ContactSurface::exact, 1, known);
}

// Of a quadrilateral, with a stretch, or of a triangle.
Heights random_heights(test::Random& random, int sides = 4) {
  Heights heights{{FaceHeights{}}};
  for (double& c : heights.face[0].C.reshaped()) c = random.uniform(-1, 1);
  if (sides == 4)
    heights.face[0].stretch = {random.uniform(0, 1) < 0.5, random.uniform(-0.5, 0.5), random.uniform(0, 0.3),
                               random.uniform(0, 0.5)};
  return heights;
}

TEST(Heights, reproduce_polynomials_of_their_degree) {
  const auto polynomial = [](const Vector3d& x) {
    return 0.3 + x[0] - 2 * x[1] + 4 * std::pow(x[0], 4) * x[1] * x[1] - std::pow(x[1], 6);
  };
  for (int sides : {3, 4}) {
    const model::Surface s = one_face(sides);
    TrueSurface known;
    for (int f = 0; f < s.face.cols(); ++f)
      known.height.push_back(sampled_heights(s, f, [&](auto& x, auto&) { return polynomial(x); }));
    const Heights heights = exact(s, known);
    const Topology map = topology(s.face, static_cast<int>(s.X.cols()));
    for (int f = 0; f < s.face.cols(); ++f)
      for (const Vector2d& at : {Vector2d(0.1, 0.2), Vector2d(0.7, 0.25), Vector2d(0, 1)}) {
        const Vector3d x = combine(face_of({s.face, map, s.X, 0}, f), shape(sides, at[0], at[1]).N);
        EXPECT_NEAR(height(heights, sides, f, at[0], at[1]).f, polynomial(x), kRoundoff) << sides;
      }
  }
}

// Heights over the first face of an involute go with the power 3/2 of the distance from its origin, which is
// no polynomial, but the cube of the roll angle.
TEST(Heights, follow_an_involute_from_its_base_circle_on) {
  const model::Surface s = one_face(4);  // 0 <= x <= 1
  const Topology map = topology(s.face, static_cast<int>(s.X.cols()));
  const auto involute = [](const Vector3d& x, const Vector3d&) { return std::pow(std::max(0.0, x[0]), 1.5); };
  const auto farthest = [&](const Stretch& stretch) {
    TrueSurface known{.height = {sampled_heights(s, 0, involute, stretch)}};
    const Heights heights = exact(s, known);
    double most = 0;
    for (double u = -1; u <= 1; u += 0.01) {
      const Vector3d x = combine(face_of({s.face, map, s.X, 0}, 0), shape(4, u, 0.3).N);
      most = std::max(most, std::abs(height(heights, 4, 0, u, 0.3).f - involute(x, x)));
    }
    return most;
  };
  EXPECT_LT(farthest({.amount = 0.95}), 2e-6);
  EXPECT_GT(farthest({}), 2e-4);
}

TEST(Heights, have_the_derivatives_of_their_values_beyond_the_sides_too) {
  test::Random random(1);
  const double h = 1e-5;
  for (int sides : {3, 4})
    for (int trial = 0; trial < 40; ++trial) {
      const Heights heights = random_heights(random, sides);
      const auto at = [&](double u, double v) { return height(heights, sides, 0, u, v); };
      const double u = random.uniform(-1.5, 1.5), v = random.uniform(-1.5, 1.5);
      const FaceFunction f = at(u, v), right = at(u + h, v), left = at(u - h, v), up = at(u, v + h),
                         down = at(u, v - h);
      const double tolerance = 1e-6 * 1e4;  // of the largest second derivative
      EXPECT_NEAR(f.f_a[0], (right.f - left.f) / (2 * h), tolerance);
      EXPECT_NEAR(f.f_a[1], (up.f - down.f) / (2 * h), tolerance);
      EXPECT_LT((f.f_ab.col(0) - (right.f_a - left.f_a) / (2 * h)).norm(), tolerance);
      EXPECT_LT((f.f_ab.col(1) - (up.f_a - down.f_a) / (2 * h)).norm(), tolerance);
    }
}

TEST(Heights, go_on_as_a_parabola_beyond_the_sides) {
  test::Random random(2);
  Heights heights = random_heights(random);
  heights.face[0].stretch.bulge = heights.face[0].stretch.fall = 0;
  const FaceFunction end = height(heights, 4, 0, 1, 0.3);
  for (double beyond : {0.1, 0.4, 1.0})
    EXPECT_NEAR(height(heights, 4, 0, 1 + beyond, 0.3).f,
                end.f + beyond * end.f_a[0] + 0.5 * beyond * beyond * end.f_ab(0, 0), 1e-10);
}

// Before the line that bends into the face nothing changes, and it is crossed without a kink.
TEST(Heights, fall_away_beyond_the_line_that_they_begin_at) {
  test::Random random(4);
  constexpr double kFall = 0.2, kBulge = 0.1;
  Heights falling = random_heights(random);
  for (double amount : {0.5, -0.5}) {
    falling.face[0].stretch = {0, amount, kBulge, kFall};
    Heights going_on = falling;
    going_on.face[0].stretch.fall = 0;
    const double side = amount > 0 ? -1 : 1, v = 0.3;
    const double half = kBulge / 2 * (1 - v * v), begin = side * (1 - half) / (1 + half);
    const auto at = [&](const Heights& heights, double u) { return height(heights, 4, 0, u, v); };
    for (double within : {0.0, 0.5, 1.9})
      EXPECT_NEAR(at(falling, begin - side * within).f, at(going_on, begin - side * within).f, kRoundoff);
    const FaceFunction end = at(going_on, begin);
    for (double beyond : {1e-6, 0.02, 0.1, 0.5}) {
      const double tangent = end.f + side * beyond * end.f_a[0], way = (1 + half) * beyond;
      EXPECT_NEAR(at(falling, begin + side * beyond).f, tangent - kFall * (std::hypot(way, 1e-3) - 1e-3),
                  1e-10);
    }
  }
}

TEST(Heights, stay_within_their_bounds_and_reach_them) {
  test::Random random(3);
  for (double extension : {0.0, 0.2}) {
    const Heights heights = random_heights(random);
    const double most = largest_height(heights, extension), end = 1 + 2 * extension;
    double found = 0;
    for (double u = -end; u <= end; u += 0.02)
      for (double v = -end; v <= end; v += 0.02)
        found = std::max(found, std::abs(height(heights, 4, 0, u, v).f));
    EXPECT_LE(found, most);
  }
  Heights parabola{{FaceHeights{}}};
  parabola.face[0].C(2, 0) = -3;  // -3 (2 u^2 - 1)
  EXPECT_NEAR(largest_height(parabola, 0), 3, kRoundoff);
  EXPECT_NEAR(largest_height(parabola, 0.5), 21, kRoundoff);
}

TEST(Heights, of_deviations_are_linear_between_nodes_on_any_surface) {
  for (int sides : {3, 4}) {
    const model::Surface s = one_face(sides);
    const Topology map = topology(s.face, static_cast<int>(s.X.cols()));
    const TrueSurface known{.deviation = Eigen::Vector4d(1, 2, 4, 8)};
    for (ContactSurface kind : {ContactSurface::facets, ContactSurface::smooth, ContactSurface::exact}) {
      const Heights heights = make_heights({s.face, map, s.X, 0}, kind, 1, known);
      for (int f = 0; f < s.face.cols(); ++f) {
        const Eigen::Vector4d N = shape(sides, 0.2, 0.6).N;
        double expected = 0;
        for (int i = 0; i < sides; ++i) expected += N[i] * known.deviation[s.face(i, f)];
        EXPECT_NEAR(height(heights, sides, f, 0.2, 0.6).f, expected, kRoundoff);
      }
    }
  }
}

TEST(Heights, of_deviations_count_along_the_normal_of_an_exact_surface) {
  constexpr double kAdded = 1e-3, kTurn = 0.2;  // m, on a radius of 1 m; rad, between facets
  const model::Surface s = test::grid(
      4, 1, [](double u, double v) { return Vector3d(std::sin(4 * kTurn * u), v, std::cos(4 * kTurn * u)); });
  TrueSurface known{.deviation = Eigen::VectorXd::Constant(s.X.cols(), kAdded)};
  for (int f = 0; f < s.face.cols(); ++f)
    known.height.push_back(sampled_heights(s, f, [](const Vector3d& x, const Vector3d& n) {
      const double b = x.x() * n.x() + x.z() * n.z(), c = x.x() * x.x() + x.z() * x.z() - 1;
      return std::abs(std::sqrt(b * b - c)) * (b > 0 ? 1 : -1) - b;
    }));
  const Heights heights = exact(s, known);
  const Topology map = topology(s.face, static_cast<int>(s.X.cols()));
  for (int f = 0; f < s.face.cols(); ++f)
    for (double u : {-0.98, -0.4, 0.1, 0.7}) {
      const Face face = face_of({s.face, map, s.X, 0}, f);
      const Vector3d x =
          combine(face, shape(4, u, 0.3).N) + height(heights, 4, f, u, 0.3).f * normal(face, u, 0.3);
      EXPECT_NEAR(std::hypot(x.x(), x.z()), 1 + kAdded, 2e-5 * kAdded);  // along the face: up to 5e-3
    }
}

TEST(Heights, of_another_surface_are_refused) {
  const model::Surface s = one_face(4);
  const auto zero = [](auto&, auto&) { return 0.0; };
  const ExactHeights right = sampled_heights(s, 0, zero);
  EXPECT_NO_THROW(exact(s, {.height = {right}}));
  EXPECT_THROW(exact(s, {.height = {right, right}}), Error);
  EXPECT_THROW(exact(s, {.height = {{Eigen::VectorXd::Zero(5)}}}), Error);
  EXPECT_THROW(exact(s, {.height = {{right.value * NAN}}}), Error);
  EXPECT_THROW(exact(s, {.height = {{right.value, Stretch{.amount = 1}}}}), Error);
  EXPECT_THROW(exact(s, {.height = {{right.value, Stretch{.amount = 0.5, .fall = -1}}}}), Error);
  EXPECT_THROW(exact(s, {.height = {{right.value, Stretch{.fall = 1}}}}), Error);
  EXPECT_THROW(exact(s, {.deviation = Eigen::Vector3d::Zero()}), Error);
  EXPECT_THROW(exact(s, {.deviation = Eigen::Vector4d::Constant(NAN)}), Error);
}

// A flat punch on a plane with a deviation of one node meets what is added, with the force of its depth.
TEST(Heights, of_a_deviation_are_felt_on_facets) {
  const model::Surface master = test::plane(2, 2), punch = test::flipped(test::plane(1, 1, 1e-3, 1e-3));
  Settings settings;
  settings.surface = ContactSurface::facets;
  settings.stiffness = 3;
  settings.penalty = Penalty::per_node;
  settings.depth = 0.1;
  TrueSurface known{.deviation = Eigen::VectorXd::Zero(9)};
  known.deviation[4] = 0.02;  // in the middle
  Pair pair(punch, master, settings, {}, {nullptr, &known});
  double force = 0;
  for (const ContactPoint& c : pair.detect(test::at(punch, {0.5, 0.5, 0.01}), test::at(master))) {
    EXPECT_NEAR(c.g_n, -0.01, 1e-4);
    force += c.f.z();
  }
  EXPECT_NEAR(force, 4 * 3 * 0.01, 2e-3);
  Pair plain(punch, master, settings);
  EXPECT_TRUE(plain.detect(test::at(punch, {0.5, 0.5, 0.01}), test::at(master)).empty());
}

}  // namespace
}  // namespace elastogear::contact::heights_test
