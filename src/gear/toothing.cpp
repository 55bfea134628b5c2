#include "elastogear/gear/toothing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

double flank_distance(const Toothing& t, int tooth, int side, const Eigen::Vector3d& x) {
  const double turned = std::atan2(x[1], x[0]) - x[2] / t.p - tooth_angle(t, tooth);
  const double theta = std::remainder(turned, 2 * pi), r = std::hypot(x[0], x[1]);
  const HalfAngle half = half_angle(t, r, side * x[2]);
  const double F = side * theta - half.psi;
  if (!t.half_angle) return t.r_b * std::cos(t.beta_b) * F;
  return F / std::hypot(1 / r, 1 / t.p + half.d_z, half.d_r);
}

}  // namespace elastogear::gear
