// Shear below a patch of contact (docs/theory, section 10.6).

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "elastogear/model/hertz.h"

namespace elastogear::model {
namespace {

using std::numbers::pi;

constexpr double kDeepest = 1.5;  // half widths, below which no shear is largest

// The largest value of f over an interval, and where: by halving the step around the best of even places.
template <class F>
ShearBelow largest_over(double from, double to, const F& f) {
  constexpr int kPlaces = 24, kHalvings = 20;
  const double even = (to - from) / kPlaces;
  ShearBelow best{f(from), from};
  const auto look = [&](double x) {
    if (x < from || x > to) return;
    if (const double value = f(x); value > best.stress) best = {value, x};
  };
  for (int i = 1; i <= kPlaces; ++i) look(from + i * even);
  double step = even;
  for (int i = 0; i < kHalvings; ++i) {
    step /= 2;
    const double middle = best.depth;
    look(middle - step);
    look(middle + step);
  }
  return best;
}

// Over the largest pressure, in the plane across a line that slides along x, at x and z in half widths. Eq.
// (10.13), E. McEwen (Phil. Mag. 40 (1949) 454-459).
double shear_of_line(double x, double z, double mu) {
  const double q = 1 - x * x + z * z, root = std::hypot(q, 2 * x * z);
  const double m = std::sqrt(std::max(0., (root + q) / 2));
  const double n = std::copysign(std::sqrt(std::max(0., (root - q) / 2)), x);
  const double size = m * m + n * n;
  if (size == 0) return 0;
  const double stress_x = -(m * (1 + (z * z + n * n) / size) - 2 * z),
               stress_z = -m * (1 - (z * z + n * n) / size), shear = -n * (m * m - z * z) / size;
  const double by_friction_x = n * (2 - (z * z - m * m) / size) - 2 * x;
  return std::hypot((stress_x + mu * by_friction_x - stress_z - mu * shear) / 2, shear + mu * stress_x);
}

// Over the largest pressure, on the axis of an ellipse, at the depth z in half minor axes: what J.
// Boussinesq's point loads add up to. Eq. (10.14).
double shear_of_ellipse(double axes, double z) {
  constexpr double kNu = 0.3;  // 0.25 to 0.4 change the shear by 2 %
  constexpr int kAngles = 48, kRadii = 160;
  std::array<double, 3> stress{0, 0, 0};
  for (int i = 0; i < kAngles; ++i) {
    const double u = (i + 0.5) / kAngles, angle = u * u * u * pi / 2;  // dense along the major axis
    const double c = std::cos(angle), s = std::sin(angle), of_angle = 3 * u * u * pi / 2 / kAngles;
    const double g = axes * axes * c * c + s * s, end = std::atan(1 / (z * std::sqrt(g)));
    for (int j = 0; j < kRadii; ++j) {  // r = z tan(t): even in t
      const double t = (j + 0.5) * end / kRadii, r = z * std::tan(t), R = z / std::cos(t);
      const double area = 4 * r * (R * R / z) * (end / kRadii) * of_angle;
      const double force = std::sqrt(std::max(0., 1 - g * r * r)) * area / (2 * pi);
      const double near = (1 - 2 * kNu) / (r * r), far = 3 * z * r * r / std::pow(R, 5);
      const double turned = (1 - z / R) * (c * c - s * s), along = z * r * r / (R * R * R);
      stress[0] += force * (near * (turned + along * s * s) - far * c * c);
      stress[1] += force * (near * (-turned + along * c * c) - far * s * s);
      stress[2] -= force * 3 * z * z * z / std::pow(R, 5);
    }
  }
  return std::max(std::abs(stress[2] - stress[0]), std::abs(stress[2] - stress[1])) / 2;
}

}  // namespace

ShearBelow largest_shear(const HertzPatch& patch, double mu) {
  ShearBelow found;
  if (patch.axes > 0) {
    found = largest_over(0.05, kDeepest, [&](double z) { return shear_of_ellipse(patch.axes, z); });
  } else {
    const auto at_depth = [&](double z) {
      if (mu == 0) return shear_of_line(0, z, 0);
      return largest_over(-1.2, 1.2, [&](double x) { return shear_of_line(x, z, mu); }).stress;
    };
    found = largest_over(0, kDeepest, at_depth);
  }
  return {found.stress * patch.pressure, found.depth * patch.half_width};
}

}  // namespace elastogear::model
