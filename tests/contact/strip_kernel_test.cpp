// Half-spaces below strips of a line of contact, beside numerical integrals and H. Hertz's line contact.

#include "elastogear/contact/strip_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "elastogear/contact/station_law.h"

namespace elastogear::contact::strip_kernel_test {
namespace {

// Integral from a to b by Gauss's rule with three points on n even parts.
double integral(const std::function<double(double)>& g, double a, double b, int n) {
  const double h = (b - a) / n;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double middle = a + (i + 0.5) * h, off = h / 2 * std::sqrt(0.6);
    sum += (5 * g(middle - off) + 8 * g(middle) + 5 * g(middle + off)) * h / 18;
  }
  return sum;
}

// The mean of 1/r between points of a line and points of a rectangle of the half width q around it, at a
// distance z along it, by substitutions that take the singularity out.
double mean_over_width(double z, double q) {
  return integral([&](double s) { return 3 * s * s / std::hypot(q * s * s * s, z); }, 0, 1, 200);
}

TEST(StripKernel, between_strips_is_the_mean_of_inverse_distances) {
  const double q = 0.3;
  for (const Strip b : {Strip{2.5, 4}, Strip{-7, -6.5}, Strip{2, 2.7}}) {
    const Strip a{0.5, 1.9};
    const double numeric =
        integral(
            [&](double z) {
              return integral([&](double y) { return mean_over_width(z - y, q); }, b.from, b.to, 12) /
                     b.length();
            },
            a.from, a.to, 12) /
        a.length();
    EXPECT_NEAR(line_inverse_distance(a, b, q), numeric, 1e-6 * numeric);
    EXPECT_NEAR(line_inverse_distance(b, a, q), numeric, 1e-6 * numeric);
  }
}

TEST(StripKernel, of_a_line_load_is_the_limit_of_small_widths) {
  const Strip a{0, 1};
  for (const Strip b : {Strip{1, 2}, Strip{3, 5}, Strip{-2, 0}})
    EXPECT_NEAR(line_inverse_distance(a, b, 0), line_inverse_distance(a, b, 1e-5), 1e-4);
}

TEST(StripKernel, of_a_strip_on_itself_is_the_mean_of_inverse_distances) {
  const double D = 1.7;
  for (double q : {0.05, 0.3, 1.7}) {
    // Pairs of points at a distance z are as many as D - z is long.
    const double numeric = integral(
        [&](double s) {
          const double z = D * s * s * s;
          return 2 * (D - z) / (D * D) * mean_over_width(z, q) * 3 * D * s * s;
        },
        0, 1, 200);
    EXPECT_NEAR(line_inverse_distance({0, D}, {0, D}, q), numeric, 1e-5 * numeric) << q;
  }
}

// Pressures of one width do work on what they do, whatever their strips' lengths are beside it, and images at
// free ends add to it: H and H less its images have no eigenvalue at or below zero.
TEST(StripKernel, is_positive_definite_on_strips_of_any_length_beside_their_width) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (int n : {2, 16, 48})
    for (double q : {0.02, 0.3, 1., 3., 10.})  // over the length of a strip
      for (const FreeEnds& ends :
           {FreeEnds{}, FreeEnds{0, infinity}, FreeEnds{0, 1. * n}, FreeEnds{-2, n + 0.5}}) {
        std::vector<Strip> strips;
        for (int i = 0; i < n; ++i) strips.push_back({1. * i, i + 1.});
        const Eigen::MatrixXd H = line_kernel(strips, q, ends), alone = line_kernel(strips, q, {});
        const auto least = [](const Eigen::MatrixXd& M) {
          return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues().minCoeff();
        };
        EXPECT_GT(least(alone), 0.3 / (0.3 + q)) << n << ' ' << q;
        EXPECT_GE(least(H), least(alone) * (1 - 1e-9)) << n << ' ' << q;
      }
}

// An image makes of a strip at a free end one that is twice as long, of which only one half is asked.
TEST(StripKernel, has_images_beyond_free_ends) {
  FreeEnds ends;
  EXPECT_TRUE(images({0, 1}, ends).empty());
  ends.upper = 1.5;
  const auto beyond = images({0, 1}, ends);
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_EQ(beyond[0].from, 2);
  EXPECT_EQ(beyond[0].to, 3);
  ends.lower = -0.5;
  ends.share = 0.7;
  const std::vector<Strip> strips{{0, 1}, {1, 1.5}};
  const Eigen::MatrixXd H = line_kernel(strips, 0.1, ends);
  const Strip above{1.5, 2}, below{-2, -1}, far_below{-2.5, -2};
  EXPECT_NEAR(H(0, 1),
              line_inverse_distance(strips[0], strips[1], 0.1) +
                  0.7 * (line_inverse_distance(strips[0], above, 0.1) +
                         line_inverse_distance(strips[0], far_below, 0.1)),
              1e-12);
  EXPECT_NEAR(H(0, 0),
              line_inverse_distance(strips[0], strips[0], 0.1) +
                  0.7 * (line_inverse_distance(strips[0], {2, 3}, 0.1) +
                         line_inverse_distance(strips[0], below, 0.1)),
              1e-12);
  EXPECT_EQ(H(0, 1), H(1, 0));
}

const StationLaw kSteel{2e-3, 15e-3, 2 * (1 - 0.09) / (std::numbers::pi * 210e9), 0.4e-3};

// The contact is as wide as q at 1.4 kN. Beyond that over e it grows no more.
TEST(StationLaw, has_the_derivatives_that_it_says_and_is_convex) {
  for (double f : {1e-6, 1e-2, 30., 500., 520., 1000., 1e5}) {
    const double h = 1e-5 * f;
    EXPECT_NEAR((kSteel.energy(f + h) - kSteel.energy(f - h)) / (2 * h), kSteel.approach(f),
                1e-8 * kSteel.approach(f))
        << f;
    EXPECT_NEAR((kSteel.approach(f + h) - kSteel.approach(f - h)) / (2 * h), kSteel.slope(f),
                1e-8 * kSteel.secant(f))
        << f;
    EXPECT_GE(kSteel.slope(f), 0);
    EXPECT_LT(kSteel.slope(f), kSteel.secant(f));
    StationLaw flatter = kSteel, rounder = kSteel;
    const double dR = 1e-5 * kSteel.radius;
    flatter.radius += dR;
    rounder.radius -= dR;
    EXPECT_NEAR((flatter.energy(f) - rounder.energy(f)) / (2 * dR), kSteel.energy_by_radius(f),
                1e-8 * kSteel.energy(f) / kSteel.radius)
        << f;
  }
  EXPECT_EQ(kSteel.energy(0), 0);
  EXPECT_EQ(kSteel.approach(0), 0);
}

// b = sqrt(4 w R / (pi E*)) and p = sqrt(w E* / (pi R)): K. L. Johnson, Contact Mechanics (1985),
// section 4.2.
TEST(StationLaw, has_width_and_pressure_of_hertz) {
  const double w = 400e3, E = 1 / (std::numbers::pi * kSteel.compliance), f = w * kSteel.length;
  EXPECT_NEAR(kSteel.half_width(f), std::sqrt(4 * w * kSteel.radius / (std::numbers::pi * E)), 1e-15);
  EXPECT_NEAR(kSteel.pressure(f), std::sqrt(w * E / (std::numbers::pi * kSteel.radius)), 1);
}

// A long line of even load presses the middle in by (w / (pi E*)) (2 ln(2 l / b) + 1), as of
// cylinders in closed form, whatever q is and however long strips are beside the contact, which is 0.51 mm
// wide.
TEST(StationLaw, of_many_strips_is_the_approach_of_long_cylinders) {
  constexpr double kHalf = 0.2;  // m, of the line
  const double w = 400e3;
  for (double q : {0.4e-3, 1e-3})
    for (double D : {2e-3, 0.5e-3, 0.1e-3}) {
      StationLaw law = kSteel;
      law.length = D;
      law.q = q;
      const Strip middle{-D / 2, D / 2}, line{-kHalf, kHalf};
      const double f = w * D, b = law.half_width(f);
      ASSERT_NEAR(b, 0.257e-3, 1e-6);
      const double approach =
          law.approach(f) + law.compliance * w * line.length() * line_inverse_distance(middle, line, q);
      const double expected = law.compliance * w * (2 * std::log(4 * kHalf / b) + 1);
      EXPECT_NEAR(approach, expected, 1e-3 * expected) << q << ' ' << D;
    }
}

}  // namespace
}  // namespace elastogear::contact::strip_kernel_test
