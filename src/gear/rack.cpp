#include "gear/rack.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr int kSamples = 2000;  // of a trochoid, among which the crossing with the involute is looked for
constexpr int kBisections = 60;

// rad, by which the trochoid at t is farther from the tooth's axis than the involute; below 0 inside the base
// circle, where there is no involute.
double beyond_involute(const RackTip& rack, const Toothing& toothing, double t) {
  const Vector2d point = trochoid(rack, t);
  return point[1] < toothing.r_b ? -1 : point[0] - psi(toothing, point[1]);
}

// (u, h) of the tool's tip at the fraction t of its way, and the angle of its normal there.
struct TipPoint {
  Vector2d x;
  double b;
};

TipPoint tip_point(const RackTip& rack, double t) {
  const double beyond = rack.straight - (1 - t) * rack.length();
  const double b = beyond > 0 ? rack.end : rack.end - beyond / rack.rho;
  return {rack.centre - rack.rho * Vector2d(std::cos(b), std::sin(b)) +
              std::max(beyond, 0.0) * Vector2d(-std::sin(b), std::cos(b)),
          b};
}

// Where the trochoid crosses the involute outwards, from t = start on, where it is inside the involute's
// continuation. It must get outwards all the way, since where it returns another part of the tool cuts
// deeper.
Form crossing(const RackTip& rack, const Toothing& toothing, double start) {
  double inside = start, beyond = start, r = 0;
  for (int i = 0; i <= kSamples && beyond == start; ++i) {
    const double t = std::lerp(start, 1, static_cast<double>(i) / kSamples);
    const double before = std::exchange(r, trochoid(rack, t)[1]);
    if (rack.has_protuberance() && r < before) break;
    (beyond_involute(rack, toothing, t) < 0 ? inside : beyond) = t;
  }
  if (beyond == start) return {.t = 0, .r_form = 0, .undercut = true};
  for (int i = 0; i < kBisections; ++i) {
    const double t = (inside + beyond) / 2;
    (beyond_involute(rack, toothing, t) < 0 ? inside : beyond) = t;
  }
  return {beyond, trochoid(rack, beyond)[1], true};
}

}  // namespace

double RackTip::length() const { return rho * (pi / 2 - end) + straight; }

// The arc's tangent at alpha_n stands out by the amount; where that is little the arc meets the flank before
// its normal has the angle of the protuberance's flank.
RackTip rack_tip(double alpha_n, double beta, double r, double s_n, double depth, double rho,
                 const Protuberance& protuberance) {
  const double h = rho - depth, pr = protuberance.amount;
  const double u = s_n / 2 + (rho - h * std::sin(alpha_n) - pr) / std::cos(alpha_n);
  RackTip rack{
      .alpha_n = alpha_n, .cos_beta = std::cos(beta), .r = r, .centre = {u, h}, .rho = rho, .end = alpha_n};
  if (pr == 0) return rack;
  const double turn = std::min(alpha_n - protuberance.alpha, std::acos(std::max(-1.0, 1 - pr / rho)));
  rack.end = alpha_n - turn;
  rack.straight = std::max(0.0, (pr - rho * (1 - std::cos(turn))) / std::sin(turn));
  return rack;
}

// The rack point touches when the rack has moved by s = h n_u/n_h - u, which puts its normal through the
// pitch point; u and n are the transverse ones, u = u_n/cos(beta).
Vector2d trochoid(const RackTip& rack, double t) {
  const auto [point, b] = tip_point(rack, t);
  const double x = point[1] * std::cos(b) * rack.cos_beta / std::sin(b);  // u + s
  const double s = x - point[0] / rack.cos_beta;
  return {std::atan2(x, rack.r + point[1]) - s / rack.r, std::hypot(x, rack.r + point[1])};
}

double straight_depth(const RackTip& rack) { return rack.rho * std::sin(rack.alpha_n) - rack.centre[1]; }

double undercut_depth(const Toothing& t) { return t.r * std::pow(std::sin(t.alpha_t), 2); }

// From the root on an undercut trochoid runs inside the involute's continuation, then crosses it. The tip of
// a protuberance is inside where the arc's tangent is parallel to the flank.
Form form(const RackTip& rack, const Toothing& t) {
  const bool undercut = straight_depth(rack) > undercut_depth(t);
  if (rack.has_protuberance())
    return crossing(rack, t, undercut ? 0 : rack.rho * (pi / 2 - rack.alpha_n) / rack.length());
  return undercut ? crossing(rack, t, 0) : Form{1, trochoid(rack, 1)[1], false};
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
  profile.fillet = [rack, end = form(rack, t).t](double s) {
    const Vector2d point = trochoid(rack, end * s);
    return Vector2d(point[1] * std::sin(point[0]), point[1] * std::cos(point[0]));
  };
  return profile;
}

}  // namespace elastogear::gear
