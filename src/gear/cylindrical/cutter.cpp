#include "gear/cylindrical/cutter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gear/cylindrical/tip_path.h"

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr int kRadiusHalvings = 60;
constexpr double kSpared = 1e-6;  // of the pitch radius over its teeth

// At an angle c from the axis of a tooth, which is +y.
Vector2d at(double c, double r) { return {r * std::sin(c), r * std::cos(c)}; }
double angle_of(const Vector2d& x) { return std::atan2(x[0], x[1]); }

// rad, from the tooth's axis to the centre of an arc tangent to tip circle and flank: it lies on the involute
// of a tooth that is thinner by 2 rho along the base circle.
double arc_angle(const Toothing& cutter, double rho) {
  return psi(cutter, cutter.r_a - rho) - rho / cutter.r_b;
}

Vector2d arc_centre(const Cutter& cutter) {
  return at(arc_angle(cutter.teeth, cutter.rho), cutter.teeth.r_a - cutter.rho);
}

}  // namespace

Cutter cutter(const Toothing& gear, int z_0, double rho) {
  Cutter c{.teeth = {.z = z_0}, .rho = rho};
  Toothing& t = c.teeth;
  t.alpha_t = gear.alpha_t;
  t.r = gear.r * z_0 / gear.z;
  t.r_b = gear.r_b * z_0 / gear.z;
  c.a = gear.r - t.r;
  t.r_a = gear.r_f - c.a;
  const double space = pi / gear.z - psi(gear, gear.r);  // rad, half of it, at the pitch circle
  t.psi_b = space * gear.z / z_0 + involute(t.alpha_t);
  return c;
}

double largest_tip_radius(const Toothing& cutter) {
  if (cutter.r_a <= cutter.r_b || arc_angle(cutter, 0) <= 0) return -1;
  double low = 0, high = cutter.r_a - cutter.r_b;
  if (arc_angle(cutter, high) >= 0) return high;
  for (int i = 0; i < kRadiusHalvings; ++i) {
    const double middle = (low + high) / 2;
    (arc_angle(cutter, middle) >= 0 ? low : high) = middle;
  }
  return low;
}

// Eq. (9.4). A point of the arc is cut when its normal, which goes through the arc's centre, meets the pitch
// point. There the normal cuts the cutter's pitch circle. Turned until this is on the line of centres, +y,
// the cutter has moved the gear by the ratio of their teeth, against the middle of the gear's space.
Vector2d trochoid(const Cutter& cutter, const Toothing& gear, double b) {
  const Vector2d centre = arc_centre(cutter), normal = at(angle_of(centre) + b, 1);
  const double along = centre.dot(normal), r = cutter.teeth.r;
  const Vector2d pitch_point =
      centre + (std::sqrt(along * along - centre.squaredNorm() + r * r) - along) * normal;
  const double turned = angle_of(pitch_point);
  const Vector2d x = Eigen::Rotation2Dd(turned) * (centre + cutter.rho * normal) + Vector2d(0, cutter.a);
  const double in_space = angle_of(x) + turned * cutter.teeth.z / gear.z;
  return {pi / gear.z - in_space, x.norm()};
}

double last_normal(const Cutter& cutter) {
  return std::asin(cutter.teeth.r_b / (cutter.teeth.r_a - cutter.rho));
}

// On the line of action the arc's last point is farther from the base circle than its centre by rho.
double form_radius(const Cutter& cutter, const Toothing& gear) {
  const double end = along_action(cutter.teeth, cutter.teeth.r_a - cutter.rho) + cutter.rho;
  return std::hypot(gear.r_b, end + cutter.a * std::sin(gear.alpha_t));
}

double least_tip_radius(const Cutter& cutter, const Toothing& gear) {
  return std::hypot(gear.r_b, cutter.a * std::sin(gear.alpha_t));
}

// With sharp tips, which cut more, up to the fillet.
bool spares_flanks(const Cutter& cutter, const Toothing& gear) {
  TipPath path{.fillet = {}, .own = gear, .mate = cutter.teeth, .a = cutter.a, .alpha_wt = gear.alpha_t};
  path.own.r_form = path.own.r_f = form_radius(cutter, gear);
  return tip_keeps_off(path, cutter.teeth.r_a, -kSpared * gear.r / gear.z);
}

Profile shaped_profile(const Cutter& cutter, const Toothing& gear, double r_inner) {
  Profile profile{.polar = true,
                  .inwards = true,
                  .half_pitch = pi / gear.z,
                  .r_inner = r_inner,
                  .r_f = gear.r_f,
                  .r_form = gear.r_form,
                  .r_a = gear.r_a,
                  .half_width = [gear](double r) { return psi(gear, r); },
                  .fillet = {}};
  profile.fillet = [cutter, gear, end = last_normal(cutter)](double s) {
    const Vector2d point = trochoid(cutter, gear, s * end);
    return Vector2d(point[1] * std::sin(point[0]), -point[1] * std::cos(point[0]));
  };
  return profile;
}

}  // namespace elastogear::gear
