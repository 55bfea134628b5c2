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

}  // namespace

OptionTable worm_table() { return table_of(kWormRows); }

void refuse_locked(const Options& options, const Drive& drive) {
  if (options.choice("drive", {"cylindrical", "worm"}) != 1 ||
      options.choice("side", {"drive", "coast"}) == 0)
    return;
  const double friction = options.number("contact_friction");
  require(friction < drive.locking_friction, "the worm locks itself: with the friction ", friction,
          " (option -contact_friction) the wheel cannot drive it (side: coast), whatever its torque; it can "
          "below ",
          drive.locking_friction, ", tan(lead angle) cos(pressure angle)");
}

Drive worm_drive(const Options& options, const drive::Start& start) {
  const Design d = worm_design(options);
  const Geometry g = gear::derive(d);
  return {drive::worm_drive(d, g, start), drive::facts(d, g), drive::locking_friction(g)};
}

}  // namespace elastogear::app
