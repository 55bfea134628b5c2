#include "elastogear/gear/toothing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elastogear::gear {

using std::numbers::pi;

double involute(double alpha) { return std::tan(alpha) - alpha; }

double tooth_angle(const Toothing& t, int i) { return t.theta_1 + 2 * pi * i / t.z; }

double psi(const Toothing& t, double r) {
  return t.psi_b - t.sign() * involute(std::acos(std::min(1.0, t.r_b / r)));
}

double flank_distance(const Toothing& t, int tooth, int side, const Eigen::Vector3d& x) {
  const double turned = std::atan2(x[1], x[0]) - x[2] / t.p - tooth_angle(t, tooth);
  const double theta = std::remainder(turned, 2 * pi);
  return t.r_b * std::cos(t.beta_b) * (side * theta - psi(t, std::hypot(x[0], x[1])));
}

}  // namespace elastogear::gear
