#include "elastogear/gear/toothing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gear/flank_place.h"

namespace elastogear::gear {

using std::numbers::pi;

double involute(double alpha) { return std::tan(alpha) - alpha; }

double tooth_angle(const Toothing& t, int i) { return t.theta_1 + 2 * pi * i / t.z; }

HalfAngle half_angle(const Toothing& t, double r, double z) {
  if (t.half_angle) return t.half_angle(r, z);
  // dpsi/dr = -sign tan(alpha)/r at cos(alpha) = r_b/r
  const double tan_alpha = std::sqrt(std::max(0.0, r * r - t.r_b * t.r_b)) / t.r_b;
  return {.psi = t.psi_b - t.sign() * involute(std::acos(std::min(1.0, t.r_b / r))),
          .d_r = -t.sign() * tan_alpha / r};
}

FlankPlace flank_place(const Toothing& t, int tooth, int side, const Eigen::Vector3d& x) {
  const double turned = std::atan2(x[1], x[0]) - x[2] / t.p - tooth_angle(t, tooth);
  const double theta = std::abs(turned) <= pi ? turned : std::remainder(turned, 2 * pi);
  FlankPlace place{std::hypot(x[0], x[1])};
  place.half = half_angle(t, place.r, side * x[2]);
  const double F = side * theta - place.half.psi;
  place.distance = t.half_angle ? F / std::hypot(1 / place.r, 1 / t.p + place.half.d_z, place.half.d_r)
                                : t.r_b * std::cos(t.beta_b) * F;
  return place;
}

double normal_thickness(const Toothing& toothing, double r) {
  return 2 * r * psi(toothing, r) * std::cos(std::atan(r / toothing.p));
}

double flank_distance(const Toothing& t, int tooth, int side, const Eigen::Vector3d& x) {
  return flank_place(t, tooth, side, x).distance;
}

}  // namespace elastogear::gear
