#include "gear/rack.h"

#include <cmath>
#include <numbers>

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr int kSamples = 2000;  // of a trochoid, among which the crossing with the involute is looked for
constexpr int kBisections = 60;

// rad, by which the trochoid at b is farther from the tooth's axis than the involute; below 0 inside the base
// circle, where there is no involute.
double beyond_involute(const RackTip& rack, const Toothing& toothing, double b) {
  const Vector2d point = trochoid(rack, b);
  return point[1] < toothing.r_b ? -1 : point[0] - psi(toothing, point[1]);
}

}  // namespace

RackTip rack_tip(double alpha_n, double beta, double r, double s_n, double depth, double rho) {
  const double h = rho - depth;
  const double u = s_n / 2 + (rho - h * std::sin(alpha_n)) / std::cos(alpha_n);
  return {.alpha_n = alpha_n, .cos_beta = std::cos(beta), .r = r, .centre = {u, h}, .rho = rho};
}

// The rack point touches when the rack has moved by s = h n_u/n_h - u, which puts its normal through the
// pitch point; u and n are the transverse ones, u = u_n/cos(beta).
Vector2d trochoid(const RackTip& rack, double b) {
  const Vector2d point = rack.centre - rack.rho * Vector2d(std::cos(b), std::sin(b));
  const double x = point[1] * std::cos(b) * rack.cos_beta / std::sin(b);  // u + s
  const double s = x - point[0] / rack.cos_beta;
  return {std::atan2(x, rack.r + point[1]) - s / rack.r, std::hypot(x, rack.r + point[1])};
}

double straight_depth(const RackTip& rack) { return rack.rho * std::sin(rack.alpha_n) - rack.centre[1]; }

double undercut_depth(const Toothing& t) { return t.r * std::pow(std::sin(t.alpha_t), 2); }

// From the root on an undercut trochoid runs inside the involute's continuation, then crosses it.
Form form(const RackTip& rack, const Toothing& t) {
  if (straight_depth(rack) <= undercut_depth(t))
    return {rack.alpha_n, trochoid(rack, rack.alpha_n)[1], false};
  double inside = pi / 2, beyond = rack.alpha_n;
  for (int i = 1; i <= kSamples; ++i) {
    beyond = std::lerp(pi / 2, rack.alpha_n, static_cast<double>(i) / kSamples);
    if (beyond_involute(rack, t, beyond) >= 0) break;
    inside = beyond;
  }
  for (int i = 0; i < kBisections; ++i) {
    const double b = (inside + beyond) / 2;
    (beyond_involute(rack, t, b) < 0 ? inside : beyond) = b;
  }
  return {beyond, trochoid(rack, beyond)[1], true};
}

Profile generated_profile(const RackTip& rack, const Toothing& t, double r_inner) {
  Profile profile{.polar = true,
                  .inwards = false,
                  .half_pitch = pi / t.z,
                  .r_inner = r_inner,
                  .r_f = t.r_f,
                  .r_form = t.r_form,
                  .r_a = t.r_a,
                  .half_width = [t](double r) { return psi(t, r); },
                  .fillet = {}};
  profile.fillet = [rack, end = form(rack, t).b](double s) {
    const Vector2d point = trochoid(rack, std::lerp(pi / 2, end, s));
    return Vector2d(point[1] * std::sin(point[0]), point[1] * std::cos(point[0]));
  };
  return profile;
}

}  // namespace elastogear::gear
