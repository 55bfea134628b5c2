#include "elastogear/drive/facts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "elastogear/gear/toothing.h"

namespace elastogear::drive {
namespace {

using std::numbers::pi;

// "pitch / tip diameter" of lengths in m.
Fact lengths(std::string name, std::vector<Figure> figures) {
  for (Figure& figure : figures) figure.unit = "m";
  return {std::move(name), std::move(figures)};
}

Fact number(const std::string& name, double value, const std::string& suffix = "") {
  return {name, {{name, value, "1", suffix}}};
}

Fact angle(const std::string& name, double value, const std::string& suffix = "") {
  return {name, {{name, value, "rad", suffix}}};
}

Fact diameters(const gear::Toothing& t) {
  return lengths("pitch / tip / root diameter",
                 {{"pitch diameter", 2 * t.r}, {"tip diameter", 2 * t.r_a}, {"root diameter", 2 * t.r_f}});
}

Fact form_diameter(const gear::Toothing& t) {
  if (t.r_b > 0)
    return lengths("base / form diameter", {{"base diameter", 2 * t.r_b}, {"form diameter", 2 * t.r_form}});
  return lengths("form diameter", {{"form diameter", 2 * t.r_form}});
}

Facts facts_of_gear(const gear::CylindricalDrive& d, const gear::CylindricalGeometry& g, std::size_t i) {
  const gear::Toothing& t = g.gear[i];
  const gear::Blank& b = g.blank[i];
  const char* form = t.internal      ? ", internal"
                     : d.rack.pr > 0 ? ", undercut by protuberance"
                     : t.undercut    ? ", undercut"
                                     : "";
  Facts all = {
      number("teeth", t.z, form),
      number("profile shift", d.gears[i].x),
      diameters(t),
      form_diameter(t),
      lengths("tip thickness", {{"tip thickness", gear::normal_thickness(t, t.r_a)}}),
      lengths(t.internal ? "face width / outer diameter" : "face width / bore",
              {{"face width", b.face_width}, {t.internal ? "outer diameter" : "bore", b.end_diameter()}})};
  if (t.internal)
    all.push_back({"cutter",
                   {{"cutter teeth", static_cast<double>(g.cutter[i].z_0), "1", " teeth"},
                    {"cutter tip radius", g.cutter[i].rho_a0 * d.m_n, "m", " tip radius"}}});
  return all;
}

// The largest sliding is where contact begins or ends, over the speed of the pitch circle.
Facts facts_of_pair(const gear::CylindricalDrive& d, const gear::CylindricalGeometry& g, std::size_t i) {
  const gear::PairGeometry& p = g.pair[i];
  const gear::Toothing &t_1 = g.gear[static_cast<std::size_t>(d.pairs[i].first)],
                       &t_2 = g.gear[static_cast<std::size_t>(d.pairs[i].second)];
  const double pitch_point = t_1.r_b * std::tan(p.alpha_wt), both = t_1.sign() * t_2.sign();
  const double farthest = std::max(std::abs(pitch_point - p.path[0]), std::abs(p.path[1] - pitch_point));
  const double sliding = farthest * std::abs(1 / t_1.r_b + both / t_2.r_b) * std::cos(p.alpha_wt);
  return {lengths("centre distance", {{"centre distance", p.a}}),
          number("ratio", static_cast<double>(t_2.z) / t_1.z, both > 0 ? "" : " in one sense"),
          angle("working pressure angle", p.alpha_wt, ", transverse"),
          lengths("normal base pitch", {{"normal base pitch", g.p_bn}}),
          {"contact ratio",
           {{"contact ratio", p.epsilon_alpha, "1", " transverse"},
            {"overlap ratio", p.epsilon_beta, "1", " overlap"}}},
          lengths("normal backlash", {{"normal backlash", p.j_n}}),
          lengths("tip clearances", {{"first tip clearance", p.c[0]}, {"second tip clearance", p.c[1]}}),
          number("largest sliding", sliding, " of the pitch-line speed")};
}

Facts facts_of_member(const gear::Toothing& t, double width, double bore) {
  return {number("teeth", t.z), diameters(t), form_diameter(t),
          lengths("width / bore", {{"width", width}, {"bore", bore}})};
}

Facts facts_of_worm(const gear::Design& d, const gear::Geometry& g) {
  constexpr const char* kForms[] = {"ZA", "ZN", "ZI", "ZK"};
  Facts all = facts_of_member(g.worm, d.thread_length, d.worm_bore);
  const char* hand = d.hand == gear::Hand::left ? ", left-handed" : ", right-handed";
  all.push_back({"flank form", {}, std::string(kForms[static_cast<int>(d.flank)]) + hand});
  if (g.cutter_diameter > 0)
    all.push_back(lengths("cutter diameter", {{"cutter diameter", g.cutter_diameter}}));
  return all;
}

Facts facts_of_wheel(const gear::Design& d, const gear::Geometry& g) {
  Facts all = facts_of_member(g.wheel, d.face_width, d.wheel_bore);
  if (g.throat_radius > 0)
    all.push_back(lengths("throat radius / outside diameter",
                          {{"throat radius", g.throat_radius}, {"outside diameter", g.outside_diameter}}));
  if (d.wheel_form == gear::WheelForm::helical) return all;
  all.push_back(lengths("hob pitch / tip diameter",
                        {{"hob pitch diameter", 2 * g.worm.r + d.hob_oversize},
                         {"hob tip diameter", 2 * (g.worm.r + d.dedendum) + d.hob_oversize}}));
  all.push_back(angle("hob swivel", g.hob_swivel));
  return all;
}

Facts facts_of_pair(const gear::Design& d, const gear::Geometry& g) {
  const double reference = 2 * (g.worm.r - g.shift), m_x = g.p_x / pi;
  return {lengths("centre distance", {{"centre distance", d.a}}),
          number("ratio", g.ratio),
          angle("lead angle", g.gamma),
          number("diameter quotient", reference / m_x),
          lengths("reference diameter of the worm / axial module",
                  {{"reference diameter", reference}, {"axial module", m_x}}),
          {"profile shift of the wheel", {{"profile shift", d.x2}}},
          number("friction that locks the worm", locking_friction(g), " and more"),
          lengths("normal base pitch", {{"normal base pitch", g.p_bn}}),
          number("contact ratio", g.epsilon),
          lengths("normal backlash", {{"normal backlash", g.j_n}}),
          lengths("tip clearances", {{"first tip clearance", d.a - g.worm.r_a - g.wheel.r_f},
                                     {"second tip clearance", d.a - g.wheel.r_a - g.worm.r_f}})};
}

}  // namespace

DriveFacts facts(const gear::CylindricalDrive& d, const gear::CylindricalGeometry& g) {
  DriveFacts all;
  for (std::size_t i = 0; i < d.gears.size(); ++i) all.members.push_back(facts_of_gear(d, g, i));
  for (std::size_t i = 0; i < d.pairs.size(); ++i) all.pairs.push_back(facts_of_pair(d, g, i));
  return all;
}

DriveFacts facts(const gear::Design& d, const gear::Geometry& g) {
  return {{facts_of_worm(d, g), facts_of_wheel(d, g)}, {facts_of_pair(d, g)}};
}

double locking_friction(const gear::Geometry& g) { return std::tan(g.gamma_w) * std::cos(g.alpha_w); }

}  // namespace elastogear::drive
