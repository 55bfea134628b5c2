#include "gear/profile.h"

#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

// Unit normal of the worm's axial flank, towards the space. The slope is d(p psi)/dr = -p tan(alpha)/r.
Vector2d worm_normal(const Toothing& worm, double r) {
  const double slope = -worm.p * std::sqrt(std::max(0.0, r * r - worm.r_b * worm.r_b)) / (worm.r_b * r);
  return Vector2d(1, -slope).normalized();
}

Vector2d worm_fillet_centre(const Design& design, const Toothing& worm, double r_form) {
  return Vector2d(worm.p * psi(worm, r_form), r_form) + design.worm_fillet * worm_normal(worm, r_form);
}

// The generating rack in the normal section: u along the pitch line from the middle of the wheel's tooth, h
// outwards. Its tip is an arc about `centre`, tangent to the straight side where the normal's angle is
// alpha_n.
Vector2d rack_tip_centre(const Design& d, const Geometry& g) {
  const double h = -d.dedendum + d.wheel_rack_tip;
  return {g.s_n / 2 + (d.wheel_rack_tip - h * std::sin(d.alpha_n)) / std::cos(d.alpha_n), h};
}

// (angle from the tooth's axis, radius) of the wheel point that the rack's tip arc cuts where its normal has
// the angle beta. The rack point touches when the rack has moved by s = h n_u/n_h - u, which puts its normal
// through the pitch point; u and n are the transverse ones, u = u_n/cos(gamma).
Vector2d trochoid(const Design& d, const Geometry& g, double beta) {
  const Vector2d rack = rack_tip_centre(d, g) - d.wheel_rack_tip * Vector2d(std::cos(beta), std::sin(beta));
  const double x = rack[1] * std::cos(beta) * std::cos(g.gamma) / std::sin(beta);  // u + s
  const double s = x - rack[0] / std::cos(g.gamma);
  return {std::atan2(x, g.wheel.r + rack[1]) - s / g.wheel.r, std::hypot(x, g.wheel.r + rack[1])};
}

}  // namespace

Vector2d Profile::point(double c, double r) const {
  return polar ? Vector2d(r * std::sin(c), r * std::cos(c)) : Vector2d(c, r);
}

double Profile::lateral(const Vector2d& x) const { return polar ? std::atan2(x[0], x[1]) : x[0]; }

double worm_form_radius(const Design& design, const Geometry& g) {
  const Toothing& worm = g.worm;
  const double rho = design.worm_fillet;
  require(worm.r_f + rho >= worm.r_b, "worm_fillet = ", rho, " m does not reach from the root radius ",
          worm.r_f, " m to the flank, which exists from the base radius on: at least ", worm.r_b - worm.r_f,
          " m");
  // The arc's centre stands at r_f + rho: r + rho n_r(r) = r_f + rho, increasing in r.
  double low = worm.r_b, high = worm.r_a;
  for (int i = 0; i < 100; ++i) {
    const double r = (low + high) / 2;
    (r + rho * worm_normal(worm, r)[1] < worm.r_f + rho ? low : high) = r;
  }
  const double centre = worm_fillet_centre(design, worm, high)[0];
  require(centre <= g.p_x / 2, "worm_fillet = ", rho, " m does not fit: its centre lies ", centre,
          " m from the middle of the thread, beyond the middle of the space at ", g.p_x / 2, " m");
  return high;
}

double wheel_form_radius(const Design& design, const Geometry& g) {
  const Vector2d centre = rack_tip_centre(design, g);
  const double half_pitch = pi * design.m_n / 2;
  require(centre[0] <= half_pitch, "wheel_rack_tip = ", design.wheel_rack_tip,
          " m does not fit: the arc's centre lies ", centre[0],
          " m from the middle of the rack's space, at most half a pitch is allowed: ", half_pitch, " m");
  const double depth = design.wheel_rack_tip * std::sin(design.alpha_n) - centre[1];
  const double limit = g.wheel.r * std::pow(std::sin(g.wheel.alpha_t), 2);
  require(depth <= limit, "the wheel is undercut: the straight flank of its rack reaches ", depth,
          " m below the pitch line, at most ", limit, " m is allowed with z2 = ", design.z2,
          " and pressure_angle = ", design.alpha_n * 180 / pi, " deg");
  return trochoid(design, g, design.alpha_n)[1];
}

Profile worm_profile(const Design& design, const Geometry& geometry) {
  const Toothing& worm = geometry.worm;
  const Vector2d centre = worm_fillet_centre(design, worm, worm.r_form);
  const Vector2d end = -worm_normal(worm, worm.r_form);
  const double rho = design.worm_fillet, from = -pi / 2, sweep = std::atan2(end[1], end[0]) - from;
  return {.half_pitch = geometry.p_x / 2,
          .r_inner = design.worm_bore / 2,
          .r_f = worm.r_f,
          .r_form = worm.r_form,
          .r_a = worm.r_a,
          .half_width = [worm](double r) { return worm.p * psi(worm, r); },
          .fillet =
              [=](double t) {
                const double angle = from + t * sweep;
                return Vector2d(centre + rho * Vector2d(std::cos(angle), std::sin(angle)));
              }};
}

Profile wheel_profile(const Design& design, const Geometry& geometry) {
  const Toothing& wheel = geometry.wheel;
  Profile profile{.polar = true,
                  .half_pitch = pi / wheel.z,
                  .r_inner = design.rim_diameter / 2,
                  .r_f = wheel.r_f,
                  .r_form = wheel.r_form,
                  .r_a = wheel.r_a,
                  .half_width = [wheel](double r) { return psi(wheel, r); },
                  .fillet = {}};
  profile.fillet = [=](double t) {
    const Vector2d c_r = trochoid(design, geometry, pi / 2 + t * (design.alpha_n - pi / 2));
    return Vector2d(c_r[1] * std::sin(c_r[0]), c_r[1] * std::cos(c_r[0]));
  };
  return profile;
}

}  // namespace elastogear::gear
