// Half-spaces below strips of a line of contact, beside numerical integrals and H. Hertz's line contact.

#include "elastogear/contact/strip_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
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
    EXPECT_NEAR(own_kernel(q / D) / D, numeric, 1e-5 * numeric) << q;
    EXPECT_NEAR(line_inverse_distance({0, D}, {0, D}, q), numeric, 1e-5 * numeric) << q;
  }
}

TEST(StripKernel, has_the_derivatives_that_it_says) {
  for (double t : {1e-3, 0.02, 0.4, 3.}) {
    const double h = 1e-5 * t;
    EXPECT_NEAR((own_kernel(t + h) - own_kernel(t - h)) / (2 * h), own_kernel_slope(t),
                1e-7 * std::abs(own_kernel_slope(t)));
    const double integrand = t * t * t * own_kernel(t);
    EXPECT_NEAR((own_kernel_moment(t + h) - own_kernel_moment(t - h)) / (2 * h), integrand, 1e-8 * integrand);
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
  EXPECT_NEAR(
      H(0, 0),
      0.7 * (line_inverse_distance(strips[0], {2, 3}, 0.1) + line_inverse_distance(strips[0], below, 0.1)),
      1e-12);
  EXPECT_EQ(H(0, 1), H(1, 0));
}

const StationLaw kSteel{2e-3, 15e-3, 2 * (1 - 0.09) / (std::numbers::pi * 210e9)};

TEST(StationLaw, has_the_derivatives_that_it_says) {
  for (double f : {1e-6, 1e-2, 30., 1000., 1e5}) {
    const double h = 1e-5 * f;
    EXPECT_NEAR((kSteel.energy(f + h) - kSteel.energy(f - h)) / (2 * h), kSteel.approach(f),
                1e-8 * kSteel.approach(f))
        << f;
    EXPECT_NEAR((kSteel.approach(f + h) - kSteel.approach(f - h)) / (2 * h), kSteel.slope(f),
                1e-8 * kSteel.slope(f))
        << f;
    EXPECT_GT(kSteel.slope(f), 0);
    EXPECT_LT(kSteel.slope(f), kSteel.secant(f));
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

// A long line of even load presses the middle in by (w / (pi E*)) (2 ln(2 l / b) + 1), as cylinders in closed
// form.
TEST(StationLaw, of_many_strips_is_the_approach_of_long_cylinders) {
  constexpr int kStrips = 201;
  const double w = 400e3, f = w * kSteel.length, l = kStrips * kSteel.length;
  const Strip middle{-kSteel.length / 2, kSteel.length / 2};
  const double q = std::sqrt(std::numbers::e) / 2 * kSteel.half_width(f);
  double approach = kSteel.approach(f);
  for (int i = 1; i <= kStrips / 2; ++i) {
    const Strip other{middle.from + i * kSteel.length, middle.to + i * kSteel.length};
    approach += 2 * kSteel.compliance * f * line_inverse_distance(middle, other, q);
  }
  const double expected = kSteel.compliance * w * (2 * std::log(2 * l / kSteel.half_width(f)) + 1);
  EXPECT_NEAR(approach, expected, 1e-4 * expected);
}

}  // namespace
}  // namespace elastogear::contact::strip_kernel_test
