#include "elastogear/gear/design.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/worm/hobbed_wheel.h"
#include "gear/worm/profiles.h"
#include "gear/worm/remedy.h"
#include "gear/worm/thread_form.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;
constexpr double kMaxPressureAngle = pi / 4;
constexpr double kMaxConeSlope = 3;
constexpr double kDegree = pi / 180;
constexpr int kMaxTeeth = 1000;
constexpr double kMostShift = 1;      // axial modules
constexpr double kMinTipWidth = 0.1;  // of the module: thinner teeth count as pointed

// A named number of the design, for messages.
struct Value {
  const char* name;
  double value;
};

void require_increasing(std::initializer_list<Value> values) {
  for (auto next = values.begin() + 1; next != values.end(); ++next)
    require(next[-1].value < next->value, next->name, " = ", next->value, " m: must be above ", next[-1].name,
            " = ", next[-1].value, " m");
}

void check_positive(const Design& d) {
  const Value values[] = {{"module", d.m_n},
                          {"centre_distance", d.a},
                          {"addendum", d.addendum},
                          {"dedendum", d.dedendum},
                          {"worm_fillet", d.worm_fillet},
                          {"wheel_rack_tip", d.wheel_rack_tip},
                          {"thread_length", d.thread_length},
                          {"worm_bore", d.worm_bore},
                          {"seat_1_diameter", d.seat_1_diameter},
                          {"seat_2_diameter", d.seat_2_diameter},
                          {"shaft_1_diameter", d.shaft_1_diameter},
                          {"shaft_2_diameter", d.shaft_2_diameter},
                          {"shoulder", d.shoulder},
                          {"face_width", d.face_width},
                          {"wheel_bore", d.wheel_bore},
                          {"hub_diameter", d.hub_diameter},
                          {"hub_width", d.hub_width},
                          {"web_diameter", d.web_diameter},
                          {"web_width", d.web_width},
                          {"rim_diameter", d.rim_diameter}};
  for (const auto& [name, value] : values)
    require(std::isfinite(value) && value > 0, name, " = ", value, " m: must be positive and finite");
  for (double z : {d.seat_1_begin, d.seat_1_end, d.seat_2_begin, d.seat_2_end, d.shaft_1_end, d.shaft_2_end})
    require(std::isfinite(z), "positions along the worm's shaft must be finite, one is ", z);
}

void check_toothing(const Design& d) {
  require(d.z1 >= 1, "z1 = ", d.z1, ": the worm needs at least 1 start");
  require(d.z2 > d.z1 && d.z2 <= kMaxTeeth, "z2 = ", d.z2, ": must be above z1 = ", d.z1, " and at most ",
          kMaxTeeth);
  require(d.alpha_n > 0 && d.alpha_n <= kMaxPressureAngle, "pressure_angle = ", d.alpha_n / kDegree,
          " deg: must be above 0 and at most ", kMaxPressureAngle / kDegree, " deg");
  require(d.j_n >= 0 && d.j_n < pi * d.m_n * std::cos(d.alpha_n), "backlash = ", d.j_n,
          " m: must be at least 0 and below the normal base pitch ", pi * d.m_n * std::cos(d.alpha_n), " m");
  require(std::isfinite(d.x2) && std::abs(d.x2) <= kMostShift, "wheel_profile_shift = ", d.x2,
          ": must be between -", kMostShift, " and ", kMostShift, " (axial modules)");
  require(d.dedendum > d.addendum, "dedendum = ", d.dedendum, " m: must be above addendum = ", d.addendum,
          " m, else tips and roots touch");
}

void check_forms(const Design& d) {
  const bool helical = d.wheel_form == WheelForm::helical, throated = d.wheel_form == WheelForm::throated;
  require(!helical || d.flank == FlankForm::ZI,
          "wheel_form = helical: an involute wheel runs with form ZI alone; choose cylindrical or throated");
  require(d.cutter_diameter == 0 || d.flank == FlankForm::ZK, "cutter_diameter = ", d.cutter_diameter,
          " m: only form ZK has a cutter of finite diameter");
  require(d.cutter_diameter == 0 || (std::isfinite(d.cutter_diameter) && d.cutter_diameter >= 2 * d.m_n),
          "cutter_diameter = ", d.cutter_diameter, " m: must be finite and at least two modules, ", 2 * d.m_n,
          " m");
  require(d.outside_diameter == 0 || throated, "outside_diameter = ", d.outside_diameter,
          " m: only a throated wheel has one; choose wheel_form throated or leave it out");
  require(std::isfinite(d.outside_diameter) && d.outside_diameter >= 0,
          "outside_diameter = ", d.outside_diameter, " m: must be positive and finite");
  require(d.hob_oversize == 0 || !helical, "hob_oversize = ", d.hob_oversize,
          " m: a helical wheel is not hobbed by a worm; choose wheel_form cylindrical or throated");
  require(std::isfinite(d.hob_oversize) && d.hob_oversize >= 0, "hob_oversize = ", d.hob_oversize,
          " m: must be finite and at least 0: a hob smaller than the worm cuts away the contact");
}

// a = m_n/2 (z1/sin(gamma) + (z2 + 2 x2)/cos(gamma)): the wheel's profile shift keeps its pitch cylinder and
// the worm's reference cylinder apart.
double centre_distance(const Design& d, double gamma) {
  return d.m_n / 2 * (d.z1 / std::sin(gamma) + (d.z2 + 2 * d.x2) / std::cos(gamma));
}

// The centre distance falls from infinity at gamma = 0 to its minimum at tan(gamma)^3 = z1/(z2 + 2 x2).
double lead_angle(const Design& d) {
  double low = 0, high = std::atan(std::cbrt(d.z1 / (d.z2 + 2 * d.x2)));
  const double smallest = centre_distance(d, high);
  require(d.a >= smallest, "there is no lead angle for centre_distance = ", d.a, " m: at least ", smallest,
          " m is needed with z1 = ", d.z1, ", z2 = ", d.z2, ", module = ", d.m_n, " m");
  for (int i = 0; i < 200; ++i) {
    const double gamma = (low + high) / 2;
    (centre_distance(d, gamma) > d.a ? low : high) = gamma;
  }
  return high;
}

// Length of the path of contact from the pitch point to the tip cylinder.
double path_length(const Toothing& t) {
  const double tip = std::sqrt(t.r_a * t.r_a - t.r_b * t.r_b), pitch = std::sqrt(t.r * t.r - t.r_b * t.r_b);
  return (tip - pitch) / std::cos(t.beta_b);
}

// Radius of the contact point where the path leaves the mate's tip cylinder, `length` from the pitch point.
// The path runs along (sin beta_b1, sin alpha_n, sin beta_b2) = (worm axis, centre line, wheel axis).
double start_radius(double alpha_w, const Toothing& t, const Toothing& mate, double length) {
  return std::hypot(t.r - length * std::sin(alpha_w), length * std::sin(mate.beta_b));
}

void check_tip(const Design& d, double width, const char* body) {
  require(width >= kMinTipWidth * d.m_n, "addendum = ", d.addendum, " m: the ", body,
          "'s teeth are pointed, ", width, " m thick at the tip, at least ", kMinTipWidth * d.m_n,
          " m is needed");
}

void check_start(const Design& d, const Toothing& t, const char* body) {
  require(t.r_start > t.r_b, "addendum = ", d.addendum, " m: the contact reaches the radius ", t.r_start,
          " m of the ", body, ", inside its base circle ", t.r_b, " m");
}

void check_fillet(const Toothing& t, const char* name, double radius) {
  require(t.r_form <= t.r_start, name, " = ", radius, " m: the fillet ends at the radius ", t.r_form,
          " m, inside the path of contact, which starts at ", t.r_start, " m");
}

void check_shaft(const Design& d, const Geometry& g) {
  require(d.thread_length >= g.p_x, "thread_length = ", d.thread_length,
          " m: must be at least one axial pitch, ", g.p_x, " m");
  // The helical layers end within one pitch of the thread's ends.
  const double reach = d.thread_length / 2 + g.p_x + d.shoulder;
  require(reach < std::min(-d.seat_1_end, d.seat_2_begin), "thread_length = ", d.thread_length,
          " m: half the thread, a pitch and a shoulder take ", reach,
          " m from the middle, the seats begin at ", d.seat_1_end, " m and ", d.seat_2_begin, " m");
  require_increasing({{"shaft_1_end plus shoulder", d.shaft_1_end + d.shoulder},
                      {"seat_1_begin", d.seat_1_begin},
                      {"seat_1_end", d.seat_1_end}});
  require_increasing({{"seat_2_begin", d.seat_2_begin},
                      {"seat_2_end", d.seat_2_end},
                      {"shaft_2_end less shoulder", d.shaft_2_end - d.shoulder}});
  const Value diameters[] = {{"seat_1_diameter", d.seat_1_diameter},
                             {"seat_2_diameter", d.seat_2_diameter},
                             {"shaft_1_diameter", d.shaft_1_diameter},
                             {"shaft_2_diameter", d.shaft_2_diameter},
                             {"the worm's root diameter", 2 * g.worm.r_f}};
  for (const Value& value : diameters) require_increasing({{"worm_bore", d.worm_bore}, value});
}

// Steeper cones would squeeze the cells there flat.
void check_shoulders(const Design& d, const Geometry& g) {
  const double root = 2 * g.worm.r_f;
  const double steps[] = {root - d.seat_1_diameter, d.seat_1_diameter - d.shaft_1_diameter,
                          root - d.seat_2_diameter, d.seat_2_diameter - d.shaft_2_diameter};
  for (double step : steps)
    require(std::abs(step) / 2 <= kMaxConeSlope * d.shoulder, "shoulder = ", d.shoulder,
            " m: too short for the step of ", std::abs(step),
            " m between two diameters of the worm's shaft, at least ", std::abs(step) / 2 / kMaxConeSlope,
            " m is needed");
}

void check_wheel(const Design& d, const Geometry& g) {
  require_increasing({{"wheel_bore", d.wheel_bore},
                      {"hub_diameter", d.hub_diameter},
                      {"web_diameter", d.web_diameter},
                      {"rim_diameter", d.rim_diameter},
                      {"the wheel's root diameter", 2 * g.wheel.r_f}});
  require(d.web_width <= std::min(d.hub_width, d.face_width), "web_width = ", d.web_width,
          " m: at most hub_width = ", d.hub_width, " m and face_width = ", d.face_width, " m");
}

// The flanks of a worm are the same at any radius: with a profile shift of the wheel the pitch cylinder is
// not the one that the worm's numbers belong to. There the wheel fills what the worm and the backlash leave
// of the pitch, and the normal base pitch is the same.
void shift_pitch(const Design& d, Geometry& g) {
  g.gamma_w = g.gamma, g.alpha_w = d.alpha_n, g.m_w = d.m_n, g.s_n2 = g.s_n;
  if (d.x2 == 0) return;
  g.shift = d.x2 * g.p_x / pi;
  g.worm.r += g.shift;
  g.gamma_w = std::atan2(g.worm.p, g.worm.r);
  g.m_w = g.p_x / pi * std::cos(g.gamma_w);
  g.alpha_w = std::acos(g.p_bn / (pi * g.m_w));
  const double s_n1 = 2 * psi(g.worm, g.worm.r) * g.worm.p * std::cos(g.gamma_w);
  g.s_n2 = pi * g.m_w - s_n1 - d.j_n / std::cos(g.alpha_w);
}

Geometry pitch_geometry(const Design& d) {
  Geometry g;
  g.gamma = lead_angle(d);
  g.j_n = d.j_n;
  g.s_n = pi * d.m_n / 2 - d.j_n / (2 * std::cos(d.alpha_n));
  g.p_bn = pi * d.m_n * std::cos(d.alpha_n);
  g.p_x = pi * d.m_n / std::cos(g.gamma);
  g.ratio = static_cast<double>(d.z2) / d.z1;
  g.worm = pitch_toothing(d, d.z1, g.gamma, g.s_n);
  set_flank_form(d, g.s_n / std::cos(g.gamma), g.worm);
  shift_pitch(d, g);
  Design at_pitch = d;
  at_pitch.m_n = g.m_w, at_pitch.alpha_n = g.alpha_w;
  at_pitch.addendum += g.shift, at_pitch.dedendum -= g.shift;
  g.wheel = pitch_toothing(at_pitch, d.z2, pi / 2 - g.gamma_w, g.s_n2);
  if (d.flank == FlankForm::ZK) g.cutter_diameter = cutter_diameter(d);
  g.outside_diameter = 2 * g.wheel.r_a;
  g.worm.theta_1 = pi - pi / d.z1;  // a space faces the wheel, at worm local -x
  g.wheel.theta_1 = pi / 2;
  return g;
}

double wheel_form_radius(const Design& d, const Geometry& g) {
  const RackTip rack = wheel_rack(d, g);
  const Form f = form(rack, g.wheel);
  require(!f.undercut, "the wheel is undercut: the straight flank of its rack reaches ", straight_depth(rack),
          " m below the pitch line, at most ", undercut_depth(g.wheel), " m is allowed with z2 = ", d.z2,
          " and pressure_angle = ", d.alpha_n / kDegree, " deg");
  return f.r_form;
}

void derive_contact(const Design& d, Geometry& g) {
  const double L_1 = path_length(g.worm), L_2 = path_length(g.wheel);
  g.epsilon = (L_1 + L_2) / g.p_bn;
  require(g.epsilon >= 1, "addendum = ", d.addendum, " m: the contact ratio is ", g.epsilon,
          ", at least 1 is needed");
  g.worm.r_start = start_radius(g.alpha_w, g.worm, g.wheel, L_2);
  g.wheel.r_start = start_radius(g.alpha_w, g.wheel, g.worm, L_1);
  check_start(d, g.worm, "worm");
  check_start(d, g.wheel, "wheel");
}

void derive_helical_wheel(const Design& d, Geometry& g) {
  check_tip(d, 2 * psi(g.wheel, g.wheel.r_a) * g.wheel.r_a, "wheel");
  g.wheel.r_form = wheel_form_radius(d, g);
}

// The image of the drive in the plane z = 0 of the wheel, which changes the sides of the worm alone.
void mirror(Geometry& g) {
  for (Toothing* t : {&g.worm, &g.wheel}) t->p = -t->p, t->beta_b = -t->beta_b;
  if (!g.wheel.half_angle) return;
  g.wheel.half_angle = [right = g.wheel.half_angle](double r, double z) {
    HalfAngle half = right(r, -z);
    half.d_z = -half.d_z;
    return half;
  };
}

Geometry toothing(const Design& d) {
  check_toothing(d);
  Geometry g = pitch_geometry(d);
  check_tip(d, 2 * psi(g.worm, g.worm.r_a) * g.worm.p, "worm");
  const bool helical = d.wheel_form == WheelForm::helical;
  if (helical) derive_helical_wheel(d, g);
  g.worm.r_form = worm_form_radius(d, g);
  if (helical)
    derive_contact(d, g);
  else
    derive_hobbed(d, g);
  check_fillet(g.worm, "worm_fillet", d.worm_fillet);
  check_fillet(g.wheel, "wheel_rack_tip", d.wheel_rack_tip);
  return g;
}

// Says what would do where the teeth cannot be made.
Geometry toothing_or_remedy(const Design& d) {
  try {
    return toothing(d);
  } catch (const Error& error) {
    fail(error.what(), nearest_that_does(d, [](const Design& other) { toothing(other); }));
  }
}

}  // namespace

Geometry derive(const Design& d) {
  check_positive(d);
  check_toothing(d);
  check_forms(d);
  Geometry g = toothing_or_remedy(d);
  check_shaft(d, g);
  check_shoulders(d, g);
  check_wheel(d, g);
  if (d.hand == Hand::left) mirror(g);
  return g;
}

Design proportioned(double m_n, double alpha_n, int z1, int z2, double a, double x2) {
  Design d;
  d.m_n = m_n, d.alpha_n = alpha_n, d.z1 = z1, d.z2 = z2, d.a = a, d.x2 = x2;
  d.j_n = 0.02 * m_n;
  d.addendum = m_n, d.dedendum = 1.25 * m_n;
  d.worm_fillet = 0.35 * m_n, d.wheel_rack_tip = 0.3 * m_n;
  check_toothing(d);
  const Geometry g = pitch_geometry(d);
  const double root_1 = 2 * g.worm.r_f, root_2 = 2 * g.wheel.r_f;
  d.thread_length = 6 * g.p_x;
  d.worm_bore = 0.25 * root_1;
  d.seat_1_diameter = d.seat_2_diameter = 0.85 * root_1;
  d.shaft_1_diameter = d.shaft_2_diameter = 0.75 * root_1;
  d.shoulder = 0.1 * root_1;
  const double begin = d.thread_length / 2 + 2 * g.p_x + 2 * d.shoulder, end = begin + 0.8 * root_1;
  d.seat_1_end = -begin, d.seat_1_begin = -end;
  d.seat_2_begin = begin, d.seat_2_end = end;
  d.shaft_2_end = end + 0.5 * root_1, d.shaft_1_end = -d.shaft_2_end;
  d.face_width = 8 * m_n, d.hub_width = 11 * m_n, d.web_width = 4 * m_n;
  d.rim_diameter = root_2 - 5 * m_n;
  d.web_diameter = std::min(0.76 * root_2, d.rim_diameter - 2 * m_n);
  d.wheel_bore = 0.4 * d.web_diameter;
  d.hub_diameter = 0.6 * d.web_diameter;
  return d;
}

Blank wheel_blank(const Design& d) {
  return {.face_width = d.face_width,
          .bore = d.wheel_bore,
          .rim_diameter = d.rim_diameter,
          .hub_diameter = d.hub_diameter,
          .hub_width = d.hub_width,
          .web_diameter = d.web_diameter,
          .web_width = d.web_width};
}

}  // namespace elastogear::gear
