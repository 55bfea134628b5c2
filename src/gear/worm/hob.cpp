#include "gear/worm/hob.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/worm/secant.h"
#include "gear/worm/thread_form.h"

namespace elastogear::gear {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using std::numbers::pi;

constexpr double kMargin = 0.1;      // modules beyond the wheel's tip where its flank is solved
constexpr double kOnHob = 1e-16;     // m
constexpr double kGrazing = 1.0001;  // the hob's radius over |z|, at least

// The point's place where it cuts, once its angle about the hob's axis is known.
struct Place {
  Vector3d x, n;  // world; n: of the hob, outwards
  double travelled, along_centre_line;
};

// angle: rad about the hob's axis, from the line to the wheel's. The hob's thread moves along its axis; where
// the normal is at right angles to that motion against the wheel's turning, the point cuts: Eq. (9.6).
Place place(const Hob& h, const HobPoint& p, double angle) {
  const Vector3d axis(std::cos(h.sigma), 0, std::sin(h.sigma)), across(-axis[2], 0, axis[0]);
  const double s = std::sin(angle), c = std::cos(angle), pitch = pi * h.thread.p / h.thread.z;
  const Vector3d out(-s * across[0], -c, -s * across[2]), around(-c * across[0], s, -c * across[2]);
  const Vector3d n = p.n_x * axis + p.n_r * out - p.n_x * h.thread.p / p.r * around;
  const Vector3d x = h.a * Vector3d::UnitY() + (h.thread.p * angle - pitch + p.axial) * axis + p.r * out;
  const double along = n[1] * axis[0];
  const double travelled = -(h.travel * n.dot(axis) + n[1] * x[0] - n[0] * x[1]) / along;
  return {x + travelled * axis, n, travelled, along / n.norm()};
}

double angle_at(const Hob& h, const HobPoint& p, double z) {
  const double untilted = -std::asin(std::clamp(z / p.r, -1.0, 1.0));
  if (h.sigma == 0) return untilted;
  return secant_zero([&](double angle) { return (z - place(h, p, angle).x[2]) / p.r; }, untilted,
                     std::cos(untilted), kOnHob / p.r);
}

HalfAngle half_angle_of(const Hob& h, const Cut& c) {
  return {
      .psi = c.angle, .d_r = -c.n_r / (c.n_theta * c.r), .d_z = -c.n_z / (c.n_theta * c.r) - 1 / h.p_wheel};
}

// The arc is tangent to the tip and the flank: r - rho n_r = r_a - rho, increasing in r.
void set_tip_arc(const Design& d, Hob& h) {
  Toothing& t = h.thread;
  h.rho = d.wheel_rack_tip;
  const double from = std::max(t.r_b, t.r);
  const auto above = [&](double r) { return r - h.rho * flank_point(h, r).n_r - (t.r_a - h.rho); };
  require(above(from) < 0, "wheel_rack_tip = ", h.rho,
          " m: the arc reaches below the hob's pitch cylinder; at most ", (t.r_a - t.r) / 2, " m would do");
  t.r_form = bracketed_zero(above, from, t.r_a);
  const HobPoint end = flank_point(h, t.r_form);
  h.centre = {end.axial - h.rho * end.n_x, t.r_a - h.rho};
  require(h.centre[0] >= 0, "wheel_rack_tip = ", h.rho, " m does not fit: the arc's centre lies ",
          -h.centre[0], " m beyond the middle of the hob's tooth");
}

}  // namespace

Hob hob(const Design& d, const Geometry& g) {
  Hob h{.a = d.a + d.hob_oversize / 2, .p_wheel = g.wheel.p, .a_worm = d.a};
  Toothing& t = h.thread;
  const double r = g.worm.r - g.shift + d.hob_oversize / 2, gamma = std::asin(d.m_n * d.z1 / (2 * r));
  t = pitch_toothing(d, d.z1, gamma, g.s_n);
  set_flank_form(d, g.s_n / std::cos(gamma), t);
  thicken(t, (pi * d.m_n - 2 * g.s_n) / std::cos(gamma));
  t.r_a = t.r + d.dedendum;
  h.sigma = d.hob_oversize > 0 ? g.gamma_w - std::atan2(t.p, t.r + g.shift) : 0;
  h.travel = t.p * d.z2 / d.z1;
  set_tip_arc(d, h);
  t.r += g.shift;
  const double r_a2 = g.wheel.r_a;
  h.tip = r_a2;
  if (d.wheel_form == WheelForm::cylindrical) return h;
  h.throat = d.a - r_a2;
  h.tip = d.outside_diameter > 0 ? d.outside_diameter / 2 : r_a2 + d.m_n / 2;
  require(h.tip >= r_a2, "outside_diameter = ", 2 * h.tip, " m: at least the throat's, ", 2 * r_a2, " m");
  return h;
}

HobPoint flank_point(const Hob& h, double r) {
  const HalfAngle half = half_angle(h.thread, r);
  const Vector2d n = Vector2d(1, -h.thread.p * half.d_r).normalized();
  return {h.thread.p * half.psi, r, n[0], n[1]};
}

HobPoint arc_point(const Hob& h, double b) {
  const Vector2d n(std::cos(b), std::sin(b)), x = h.centre + h.rho * n;
  return {x[0], x[1], n[0], n[1]};
}

double arc_begin(const Hob& h) {
  const HobPoint end = flank_point(h, h.thread.r_form);
  return std::atan2(end.n_r, end.n_x);
}

Cut cut(const Hob& h, const HobPoint& p, double z) {
  const Place at = place(h, p, angle_at(h, p, z));
  const double r = std::hypot(at.x[0], at.x[1]);
  return {.r = r,
          .angle = std::atan2(-at.x[0], at.x[1]) + at.travelled / h.travel - z / h.p_wheel,
          .n_r = (at.n[0] * at.x[0] + at.n[1] * at.x[1]) / r,
          .n_theta = (at.n[1] * at.x[0] - at.n[0] * at.x[1]) / r,
          .n_z = at.n[2],
          .travelled = at.travelled,
          .denominator = at.along_centre_line};
}

double tip_radius(const Hob& h, double z) {
  if (h.throat == 0 || std::abs(z) >= h.throat) return h.tip;
  return std::min(h.tip, h.a_worm - std::sqrt(h.throat * h.throat - z * z));
}

double innermost_radius(const Hob& h, double z) {
  const double below = std::max(0.0, h.a - tip_radius(h, z) - (h.thread.r - h.thread.r_f) * 0.02);
  return std::max({std::hypot(below, z), h.thread.r_b, h.thread.r_f, kGrazing * std::abs(z)});
}

HalfAngle hobbed_half_angle(const Hob& h, double r, double z) {
  const auto at = [&](double r_hob) { return cut(h, flank_point(h, r_hob), z); };
  const auto beyond = [&](const Cut& end) {
    HalfAngle half = half_angle_of(h, end);
    half.psi += half.d_r * (r - end.r);
    return half;
  };
  const double low = innermost_radius(h, z), high = h.thread.r_form;
  const Cut tip = at(low), form = at(high);
  if (r >= tip.r) return beyond(tip);
  if (r <= form.r) return beyond(form);
  return beyond(at(bracketed_zero([&](double r_hob) { return at(r_hob).r - r; }, low, high)));
}

}  // namespace elastogear::gear
