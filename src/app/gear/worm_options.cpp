#include "app/gear/worm_options.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "app/console/console.h"
#include "app/gear/design_options.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

using gear::Design, gear::Geometry;
using std::numbers::pi;

constexpr double kPressureAngle = 20;  // deg
constexpr int kMostStarts = 6;
constexpr const char* kLocking = "friction that locks the worm";

struct WormChoices {
  int starts = 1, teeth = 0;
  double quotient = 10;
  std::optional<double> axial_module, reference_diameter;
};

const Rows<WormChoices> kWormRows = {
    {"worm_starts", &WormChoices::starts, "-", "worm: number of starts", kPositive},
    {"axial_module", &WormChoices::axial_module, "m", "worm: of the worm, in place of module", kPositive},
    {"diameter_quotient", &WormChoices::quotient, "-",
     "worm: reference diameter of the worm over its axial module (default: that of the centre distance, or "
     "10)",
     kPositive},
    {"worm_reference_diameter", &WormChoices::reference_diameter, "m",
     "worm: reference diameter of the worm, in place of diameter_quotient", kPositive},
};

// m_n, a and x2 of a drive. tan(gamma) = z1/q, m_n = m_x cos(gamma), 2 a = m_x (q + z2 + 2 x2).
struct Pitch {
  double m_n = 0, a = 0, x2 = 0;
};

// The profile shift that a centre distance and both diameters leave. As drawings round it, one that is given
// may be off in the third digit.
double shift_by(const Options& options, double a, double m_x, double q, int teeth) {
  constexpr double kRounding = 0.006, kMost = 1;
  const double x2 = a / m_x - (q + teeth) / 2;
  const bool fits = options.given("wheel_profile_shift")
                        ? std::abs(x2 - options.number("wheel_profile_shift")) <= kRounding
                        : std::abs(x2) <= kMost;
  require(fits, options.label("centre_distance"), " = ", in_mm(a), ": with the diameters of worm (",
          in_mm(m_x * q), ") and wheel (", in_mm(m_x * teeth), ") the wheel's profile shift is ", x2,
          options.given("wheel_profile_shift") ? ", not the one given; give all but one of the four"
                                               : "; it must be between -1 and 1");
  return x2;
}

Pitch pitch(const Options& options, const WormChoices& c) {
  const bool by_distance = options.given("centre_distance");
  const double x2 = options.given("wheel_profile_shift") ? options.number("wheel_profile_shift") : 0;
  const double m_n = c.axial_module ? 0 : options.positive("module");
  if (by_distance && !c.axial_module && !c.reference_diameter && !options.given("diameter_quotient"))
    return {m_n, options.positive("centre_distance"), x2};
  double q = c.quotient, m_x = c.axial_module.value_or(0);
  if (c.reference_diameter && !c.axial_module) {
    const double sine = m_n * c.starts / *c.reference_diameter;
    require(sine < 1, options.label("worm_reference_diameter"), " = ", in_mm(*c.reference_diameter),
            ": must be above ", in_mm(m_n * c.starts), ", the module times the starts");
    m_x = m_n / std::sqrt(1 - sine * sine);
  } else if (!c.axial_module) {
    m_x = m_n / std::cos(std::atan(c.starts / q));
  }
  if (c.reference_diameter) q = *c.reference_diameter / m_x;
  const bool by_diameter = c.reference_diameter || options.given("diameter_quotient");
  if (by_distance && !by_diameter) q = 2 * options.positive("centre_distance") / m_x - c.teeth - 2 * x2;
  require(q > 0, options.label("centre_distance"), ": leaves no diameter for the worm");
  const double a = by_distance ? options.positive("centre_distance") : m_x * (q + c.teeth + 2 * x2) / 2;
  return {m_x * std::cos(std::atan(c.starts / q)), a,
          by_distance && by_diameter ? shift_by(options, a, m_x, q, c.teeth) : x2};
}

// Hobs of small worms do not reach as far to the sides as the face of a helical wheel is wide.
void narrow_to_hob(Design& d) {
  constexpr double kStep = 0.25, kLeast = 3;  // modules
  const double wanted = d.face_width;
  for (; d.face_width >= kLeast * d.m_n; d.face_width -= kStep * d.m_n) try {
      gear::derive(d);
      return;
    } catch (const Error&) {  // of another cause, too: the error of the wide face tells it
    }
  d.face_width = wanted;
}

Design worm_design(const Options& options) {
  WormChoices c;
  read_rows(options, kWormRows, c);
  for (const char* name : {"z1", "z2"})
    require(!options.given(name), options.label(name),
            ": in a drive write worm: {starts: ...} and wheel: {teeth: ...}");
  require(c.starts <= kMostStarts, options.label("worm_starts"), " = ", c.starts, ": must be 1 to ",
          kMostStarts);
  require(options.given("wheel_teeth"),
          "option -wheel_teeth is missing: number of teeth, as in 'wheel: {teeth: 41}'");
  c.teeth = options.count("wheel_teeth", 1);
  require(options.given("module") || c.axial_module,
          "option -module is missing: normal module, as in 'module: 2 mm', or axial_module");
  require(!options.given("module") || !c.axial_module, "options -module and -axial_module: give one of them");
  require(!c.reference_diameter || !options.given("diameter_quotient"),
          "options -worm_reference_diameter and -diameter_quotient: give one of them");
  const Pitch p = pitch(options, c);
  const double alpha_n = options.given("pressure_angle") ? options.number("pressure_angle") : kPressureAngle;
  Design d = gear::proportioned(p.m_n, alpha_n * pi / 180, c.starts, c.teeth, p.a, p.x2);
  if (c.axial_module) d.addendum = *c.axial_module, d.dedendum = 1.25 * *c.axial_module;
  read_rows(options, design_rows(), d);
  d.m_n = p.m_n, d.a = p.a, d.x2 = p.x2;
  // Only an involute worm has a helical wheel.
  if (d.flank != gear::FlankForm::ZI && !options.given("wheel_form"))
    d.wheel_form = gear::WheelForm::throated;
  if (!options.given("face_width") && d.wheel_form != gear::WheelForm::helical) narrow_to_hob(d);
  return d;
}

Facts facts(const gear::Toothing& t, double width, double bore) {
  Facts all = {
      {"teeth", std::to_string(t.z), {{"teeth", static_cast<double>(t.z)}}},
      lengths("pitch / tip / root diameter",
              {{"pitch diameter", 2 * t.r}, {"tip diameter", 2 * t.r_a}, {"root diameter", 2 * t.r_f}})};
  if (t.r_b > 0)
    all.push_back(
        lengths("base / form diameter", {{"base diameter", 2 * t.r_b}, {"form diameter", 2 * t.r_form}}));
  else
    all.push_back(lengths("form diameter", {{"form diameter", 2 * t.r_form}}));
  all.push_back(lengths("width / bore", {{"width", width}, {"bore", bore}}));
  return all;
}

Facts worm_facts(const Design& d, const Geometry& g) {
  constexpr const char* kForms[] = {"ZA", "ZN", "ZI", "ZK"};
  Facts all = facts(g.worm, d.thread_length, d.worm_bore);
  const std::string hand = d.hand == gear::Hand::left ? ", left-handed" : ", right-handed";
  all.push_back({"flank form", kForms[static_cast<int>(d.flank)] + hand});
  if (g.cutter_diameter > 0)
    all.push_back(lengths("cutter diameter", {{"cutter diameter", g.cutter_diameter}}));
  return all;
}

Facts wheel_facts(const Design& d, const Geometry& g) {
  Facts all = facts(g.wheel, d.face_width, d.wheel_bore);
  if (g.throat_radius > 0)
    all.push_back(lengths("throat radius / outside diameter",
                          {{"throat radius", g.throat_radius}, {"outside diameter", g.outside_diameter}}));
  if (d.wheel_form == gear::WheelForm::helical) return all;
  all.push_back(lengths("hob pitch / tip diameter",
                        {{"hob pitch diameter", 2 * g.worm.r + d.hob_oversize},
                         {"hob tip diameter", 2 * (g.worm.r + d.dedendum) + d.hob_oversize}}));
  all.push_back(
      {"hob swivel", with_unit(g.hob_swivel * 180 / pi, "deg"), {{"hob swivel", g.hob_swivel, "rad"}}});
  return all;
}

Facts pair_facts(const Design& d, const Geometry& g) {
  const double locking = std::tan(g.gamma_w) * std::cos(g.alpha_w);  // tan(gamma) = mu / cos(alpha_n)
  const double reference = 2 * (g.worm.r - g.shift), quotient = reference * pi / g.p_x;
  return {lengths("centre distance", {{"centre distance", d.a}}),
          {"ratio", with_unit(g.ratio, ""), {{"ratio", g.ratio}}},
          {"lead angle", with_unit(g.gamma * 180 / pi, "deg"), {{"lead angle", g.gamma, "rad"}}},
          {"diameter quotient", with_unit(quotient, ""), {{"diameter quotient", quotient}}},
          lengths("reference diameter of the worm / axial module",
                  {{"reference diameter", reference}, {"axial module", g.p_x / pi}}),
          {"profile shift of the wheel", with_unit(d.x2, ""), {{"profile shift", d.x2}}},
          {kLocking, with_unit(locking, "and more"), {{kLocking, locking}}},
          lengths("normal base pitch", {{"normal base pitch", g.p_bn}}),
          {"contact ratio", with_unit(g.epsilon, ""), {{"contact ratio", g.epsilon}}},
          lengths("normal backlash", {{"normal backlash", g.j_n}}),
          lengths("tip clearances", {{"first tip clearance", d.a - g.worm.r_a - g.wheel.r_f},
                                     {"second tip clearance", d.a - g.wheel.r_a - g.worm.r_f}})};
}

}  // namespace

OptionTable worm_table() { return table_of(kWormRows); }

void refuse_locked(const Options& options, const Drive& drive) {
  if (options.choice("drive", {"cylindrical", "worm"}) != 1 ||
      options.choice("side", {"drive", "coast"}) == 0)
    return;
  const double friction = options.number("contact_friction");
  for (const Fact& fact : drive.pair_facts.front())
    require(fact.name != kLocking || friction < fact.figures[0].value,
            "the worm locks itself: with the friction ", friction,
            " (option -contact_friction) the wheel cannot drive it (side: coast), whatever its torque; ",
            "it can below ", fact.name == kLocking ? fact.figures[0].value : 0,
            ", tan(lead angle) cos(pressure angle)");
}

Drive worm_drive(const Options& options, const drive::Start& start) {
  const Design d = worm_design(options);
  const Geometry g = gear::derive(d);
  return {drive::worm_drive(d, g, start), {worm_facts(d, g), wheel_facts(d, g)}, {pair_facts(d, g)}};
}

}  // namespace elastogear::app
