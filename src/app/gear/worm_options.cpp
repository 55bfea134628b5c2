#include "app/gear/worm_options.h"

#include <cmath>
#include <numbers>

#include "app/console/console.h"
#include "app/gear/design_options.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::app {
namespace {

using gear::Design, gear::Geometry;
using std::numbers::pi;

constexpr double kPressureAngle = 20;  // deg
constexpr int kMostStarts = 6;

struct WormChoices {
  int starts = 1, teeth = 0;
  double quotient = 10;
};

const Rows<WormChoices> kWormRows = {
    {"worm_starts", &WormChoices::starts, "-", "worm: number of starts", kPositive},
    {"diameter_quotient", &WormChoices::quotient, "-",
     "worm: pitch diameter of the worm over its axial module, where no centre distance is given", kPositive},
};

// tan(gamma) = z1/q; the axial module is m_n/cos(gamma).
double centre_distance(double m_n, const WormChoices& c) {
  return m_n / std::cos(std::atan(c.starts / c.quotient)) * (c.quotient + c.teeth) / 2;
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
  require(options.given("module"), "option -module is missing: normal module, as in 'module: 2 mm'");
  const double m_n = options.positive("module");
  const bool by_distance = options.given("centre_distance");
  require(!by_distance || !options.given("diameter_quotient"),
          "options -centre_distance and -diameter_quotient: give one of them");
  const double alpha_n = options.given("pressure_angle") ? options.number("pressure_angle") : kPressureAngle;
  Design d = gear::proportioned(m_n, alpha_n * pi / 180, c.starts, c.teeth,
                                by_distance ? options.positive("centre_distance") : centre_distance(m_n, c));
  read_rows(options, design_rows(), d);
  // Only an involute worm has a helical wheel.
  if (d.flank != gear::FlankForm::ZI && !options.given("wheel_form"))
    d.wheel_form = gear::WheelForm::throated;
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
  const double quotient = 2 * g.worm.r * pi / g.p_x;
  return {lengths("centre distance", {{"centre distance", d.a}}),
          {"ratio", with_unit(g.ratio, ""), {{"ratio", g.ratio}}},
          {"lead angle", with_unit(g.gamma * 180 / pi, "deg"), {{"lead angle", g.gamma, "rad"}}},
          {"diameter quotient", with_unit(quotient, ""), {{"diameter quotient", quotient}}},
          lengths("normal base pitch", {{"normal base pitch", g.p_bn}}),
          {"contact ratio", with_unit(g.epsilon, ""), {{"contact ratio", g.epsilon}}},
          lengths("normal backlash", {{"normal backlash", g.j_n}}),
          lengths("tip clearances", {{"first tip clearance", d.a - g.worm.r_a - g.wheel.r_f},
                                     {"second tip clearance", d.a - g.wheel.r_a - g.worm.r_f}})};
}

}  // namespace

OptionTable worm_table() { return table_of(kWormRows); }

// Worm local (x, y, z) = world (Y, Z, X): a third of a turn about (1, 1, 1). At zero angles both flanks have
// half the backlash; a driving worm pushes the wheel from behind. A left-handed wheel turns the other way.
Drive worm_drive(const Options& options) {
  const Design d = worm_design(options);
  const Geometry g = gear::derive(d);
  const double turned = 2 * pi * options.number("roll") / d.z1;
  const double hand = d.hand == gear::Hand::left ? -1 : 1;
  const double closing = g.j_n / 2 / (g.wheel.r * std::cos(d.alpha_n) * std::cos(g.gamma));
  const double sense = options.choice("side", {"drive", "coast"}) == 0 ? 1 : -1;
  DriveMember worm{.name = "worm",
                   .toothing = g.worm,
                   .mesh =
                       [d](const MeshDensity& by) {
                         const gear::WormCounts n = gear::worm_counts(by.size, d.z1, by.order);
                         return gear::worm_mesh(d, gear::refined(n, d.z1, by.refinement));
                       },
                   .is_worm = true,
                   .held = "seats"};
  worm.position = {0, d.a, 0};
  worm.rotation = Eigen::Vector3d::Constant(2 * pi / 3 / std::sqrt(3.0));
  worm.angle = turned;
  worm.width = d.thread_length;
  DriveMember wheel{.name = "wheel",
                    .toothing = g.wheel,
                    .mesh =
                        [d](const MeshDensity& by) {
                          const gear::WheelCounts n = gear::wheel_counts(by.size, by.order);
                          return gear::wheel_mesh(d, gear::refined(n, by.refinement));
                        },
                    .held = "bore"};
  wheel.angle = hand * (turned / g.ratio - sense * closing);
  wheel.ratio = hand / g.ratio;
  wheel.width = d.face_width;
  Drive drive{.members = {worm, wheel}, .facts = {worm_facts(d, g), wheel_facts(d, g)}, .pairs = {}};
  drive.pairs.push_back({0, 1, pair_facts(d, g)});
  return drive;
}

}  // namespace elastogear::app
