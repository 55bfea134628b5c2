#include "gear/worm/profiles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

// Unit normal of the worm's axial flank, towards the space.
Vector2d worm_normal(const Toothing& worm, double r) {
  return Vector2d(1, -std::abs(worm.p) * half_angle(worm, r).d_r).normalized();
}

Vector2d worm_fillet_centre(const Design& design, const Toothing& worm, double r_form) {
  return Vector2d(std::abs(worm.p) * psi(worm, r_form), r_form) +
         design.worm_fillet * worm_normal(worm, r_form);
}

}  // namespace

double worm_form_radius(const Design& design, const Geometry& g) {
  const Toothing& worm = g.worm;
  const double rho = design.worm_fillet;
  require(worm.r_f + rho >= worm.r_b, "worm_fillet = ", rho, " m does not reach from the root radius ",
          worm.r_f, " m to the flank, which exists from the base radius on: at least ", worm.r_b - worm.r_f,
          " m");
  // The arc's centre stands at r_f + rho: r + rho n_r(r) = r_f + rho, increasing in r.
  double low = std::max(worm.r_b, worm.r_f), high = worm.r_a;
  for (int i = 0; i < 100; ++i) {
    const double r = (low + high) / 2;
    (r + rho * worm_normal(worm, r)[1] < worm.r_f + rho ? low : high) = r;
  }
  const double centre = worm_fillet_centre(design, worm, high)[0];
  require(centre <= g.p_x / 2, "worm_fillet = ", rho, " m does not fit: its centre lies ", centre,
          " m from the middle of the thread, beyond the middle of the space at ", g.p_x / 2, " m");
  return high;
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
          .half_width = [worm](double r) { return std::abs(worm.p) * psi(worm, r); },
          .fillet =
              [=](double t) {
                const double angle = from + t * sweep;
                return Vector2d(centre + rho * Vector2d(std::cos(angle), std::sin(angle)));
              }};
}

RackTip wheel_rack(const Design& d, const Geometry& g) {
  const RackTip rack =
      rack_tip(g.alpha_w, g.gamma_w, g.wheel.r, g.s_n2, d.dedendum - g.shift, d.wheel_rack_tip);
  const double half_pitch = std::numbers::pi * g.m_w / 2;
  require(rack.centre[0] <= half_pitch, "wheel_rack_tip = ", d.wheel_rack_tip,
          " m does not fit: the arc's centre lies ", rack.centre[0],
          " m from the middle of the rack's space, at most half a pitch is allowed: ", half_pitch, " m");
  return rack;
}

}  // namespace elastogear::gear
