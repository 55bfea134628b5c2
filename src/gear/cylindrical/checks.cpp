#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "elastogear/base/error.h"
#include "gear/cylindrical/derivation.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;

constexpr double kMostModule = 0.5;  // m: larger ones are given in a wrong unit
constexpr double kMostFace = 3;      // m
constexpr int kLeastTeeth = 5, kMostTeeth = 1000;
constexpr double kMostHelix = pi / 4, kMostPressureAngle = pi / 4;
constexpr double kDegree = pi / 180;

void check_cutter(const CylindricalGear& gear) {
  const PinionCutter& cutter = gear.cutter;
  require(gear.internal || (cutter.z_0 == 0 && cutter.rho_a0 < 0), gear.name,
          ": is external, which no cutter_teeth and cutter_tip_radius belong to; the rack makes its teeth");
  require(cutter.z_0 == 0 || (cutter.z_0 >= kLeastTeeth && cutter.z_0 < gear.z), gear.name,
          ": cutter_teeth = ", cutter.z_0, ": must be ", kLeastTeeth, " to ", gear.z - 1);
  require(std::isfinite(cutter.rho_a0), gear.name, ": cutter_tip_radius = ", cutter.rho_a0,
          ": must be a number of modules");
}

void check_numbers(const CylindricalDrive& d) {
  require(std::isfinite(d.m_n) && d.m_n > 0, "module = ", d.m_n, " m: must be positive");
  require(d.m_n <= kMostModule, "module = ", d.m_n, " m: is at most ", kMostModule,
          " m; write the unit, module: ", d.m_n, " mm");
  require(std::abs(d.beta) <= kMostHelix, "helix_angle = ", d.beta / kDegree, " deg: must be at most ",
          kMostHelix / kDegree, " deg to either side");
  require(d.rack.alpha_n > 0 && d.rack.alpha_n <= kMostPressureAngle,
          "pressure_angle = ", d.rack.alpha_n / kDegree, " deg: must be above 0 and at most ",
          kMostPressureAngle / kDegree, " deg");
  require(d.rack.h_aP > 0 && d.rack.h_fP > d.rack.h_aP && d.rack.rho_fP > 0,
          "basic rack: rack_addendum = ", d.rack.h_aP, ", rack_dedendum = ", d.rack.h_fP,
          " and rack_fillet = ", d.rack.rho_fP, " must be positive, and the dedendum above the addendum");
  require(!d.gears.empty(), "a drive needs gears");
  for (const CylindricalGear& gear : d.gears) {
    require(gear.z >= kLeastTeeth && gear.z <= kMostTeeth, gear.name, ": teeth = ", gear.z, ": must be ",
            kLeastTeeth, " to ", kMostTeeth);
    check_cutter(gear);
    require(std::isfinite(gear.x) && std::abs(gear.x) <= 2, gear.name, ": profile_shift = ", gear.x,
            ": must be between -2 and 2 (modules)");
    require(std::isfinite(gear.blank.face_width) && gear.blank.face_width > 0, gear.name,
            ": face_width = ", mm(gear.blank.face_width), " mm: must be positive");
    require(gear.blank.face_width <= kMostFace, gear.name, ": face_width = ", gear.blank.face_width,
            " m: is at most ", kMostFace, " m; write the unit, face_width: ", gear.blank.face_width, " mm");
  }
}

void check_pairs(const CylindricalDrive& d) {
  const int n = static_cast<int>(d.gears.size());
  std::vector<char> placed(d.gears.size(), 0);
  placed[0] = 1;
  for (const GearPair& pair : d.pairs) {
    require(pair.first >= 0 && pair.first < n && pair.second >= 0 && pair.second < n,
            "a pair names a gear that is not there");
    const std::string name = pair_name(d, pair);
    require(
        placed[pair.first] && pair.first != pair.second, "pair ", name,
        ": its first gear must be the first of all or the second of an earlier pair, and not its second one");
    for (const GearPair& earlier : d.pairs) {
      if (&earlier == &pair) break;
      require(std::minmax(earlier.first, earlier.second) != std::minmax(pair.first, pair.second), "pair ",
              name, ": is there twice; name each mate once");
    }
    require(pair.coaxial < 0 || (pair.coaxial < n && placed[pair.coaxial]), "pair ", name,
            ": its second gear shares the axis of one that has no place yet");
    const CylindricalGear &g_1 = d.gears[pair.first], &g_2 = d.gears[pair.second];
    const bool inside = g_1.internal ? g_2.z < g_1.z : g_1.z < g_2.z;
    require(!g_1.internal || !g_2.internal, "pair ", name, ": both gears are internal; one must be external");
    require(inside || (!g_1.internal && !g_2.internal), "pair ", name, ": an internal gear of ",
            g_1.internal ? g_1.z : g_2.z, " teeth has no room for ", g_1.internal ? g_2.z : g_1.z,
            "; it needs more than its mate");
    placed[pair.second] = 1;
  }
  for (int i = 0; i < n; ++i) require(placed[i], "gear ", d.gears[i].name, " is in no pair");
}

void check_protuberance(const CylindricalDrive& d) {
  constexpr double kMost = 0.2;  // modules
  constexpr double kLeastAngle = kDegree;
  const BasicRack& rack = d.rack;
  require(rack.pr >= 0 && rack.pr <= kMost, "rack_protuberance = ", rack.pr, ": must be 0 to ", kMost,
          " modules");
  require(rack.alpha_pr < 0 || rack.pr > 0, "rack_protuberance_angle = ", rack.alpha_pr / kDegree,
          " deg: needs rack_protuberance, too");
  require(rack.alpha_pr < 0 || (rack.alpha_pr >= kLeastAngle && rack.alpha_pr < rack.alpha_n),
          "rack_protuberance_angle = ", rack.alpha_pr / kDegree, " deg: must be at least ",
          kLeastAngle / kDegree, " deg and below the pressure angle of ", rack.alpha_n / kDegree, " deg");
}

// The tool's tip must fit into the space between its flanks.
void check_rack(const CylindricalDrive& d) {
  const double alpha = d.rack.alpha_n;
  check_protuberance(d);
  // Half the tip's land without rounding.
  const double room = pi / 4 - d.rack.h_fP * std::tan(alpha) + d.rack.pr / std::cos(alpha);
  require(room > 0, "basic rack: rack_dedendum = ", d.rack.h_fP,
          " is too deep for pressure_angle = ", alpha / kDegree, " deg: at most ", pi / 4 / std::tan(alpha));
  const double most = room / ((1 - std::sin(alpha)) / std::cos(alpha));
  require(d.rack.rho_fP <= most, "basic rack: rack_fillet = ", d.rack.rho_fP, " does not fit, at most ", most,
          " with pressure_angle = ", alpha / kDegree, " deg and dedendum ", d.rack.h_fP);
}

}  // namespace

std::string pair_name(const CylindricalDrive& d, const GearPair& pair) {
  return d.gears[pair.first].name + ":" + d.gears[pair.second].name;
}

void check_design(const CylindricalDrive& d) {
  check_numbers(d);
  check_pairs(d);
  check_rack(d);
}

}  // namespace elastogear::gear
