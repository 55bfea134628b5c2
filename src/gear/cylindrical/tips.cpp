#include <algorithm>
#include <cmath>
#include <sstream>

#include "elastogear/base/error.h"
#include "gear/cylindrical/derivation.h"
#include "gear/cylindrical/generating_tool.h"
#include "gear/cylindrical/tip_path.h"

namespace elastogear::gear {
namespace {

constexpr double kLeastTip = 0.1;   // modules: thinner teeth count as pointed
constexpr double kTouching = 1e-6;  // modules, by which a tip may be off the involute
constexpr int kUsualCutter = 25, kLeastCutter = 10;
constexpr double kFlankLeft = 0.1;     // modules of the line of action, between a tip and the mate's fillet
constexpr double kTipArc = 0.85;       // of the largest radius, so that a land is left
constexpr double kLeastTipArc = 0.05;  // modules

// The radius from which tips reach deeper: outwards, of internal gears inwards.
double deeper(const Toothing& t, double r) { return t.sign() * r; }

void limit_tip(Toothing& t, double r) { t.r_a = deeper(t, t.r_a) < deeper(t, r) ? t.r_a : r; }

// m, tip radius at the clearance c to the mate's root.
double tip_at_clearance(const Toothing& t, const Toothing& mate, double a, double c) {
  return t.sign() * (pair_sign(t, mate) * a - mate.sign() * mate.r_f - c);
}

template <class Visit>
void for_mates(const CylindricalDrive& d, const CylindricalGeometry& g, Visit visit) {
  for (std::size_t i = 0; i < d.pairs.size(); ++i)
    for (bool swapped : {false, true})
      visit(swapped ? d.pairs[i].second : d.pairs[i].first, swapped ? d.pairs[i].first : d.pairs[i].second,
            g.pair[i]);
}

void shorten_to_clearance(const CylindricalDrive& d, CylindricalGeometry& g) {
  for_mates(d, g, [&](int own, int mate, const PairGeometry& p) {
    if (d.gears[own].r_a <= 0)
      limit_tip(g.gear[own], tip_at_clearance(g.gear[own], g.gear[mate], p.a, kLeastClearance * d.m_n));
  });
}

// Tips of internal pairs stay within the part of the line of action that the mate's flank has, with something
// left for the deflection of the teeth.
void shorten_to_form(const CylindricalDrive& d, CylindricalGeometry& g, bool internal) {
  for_mates(d, g, [&](int own, int mate, const PairGeometry& p) {
    Toothing& t = g.gear[own];
    const Toothing& other = g.gear[mate];
    if (d.gears[own].r_a > 0 || t.internal != internal || pair_sign(t, other) > 0) return;
    const double xi = along_own(t, other, p.a * std::sin(p.alpha_wt), along_action(other, other.r_form));
    limit_tip(t, std::hypot(t.r_b, xi - t.sign() * kFlankLeft * d.m_n));
  });
}

TipPath path_in(const CylindricalDrive& d, const CylindricalGeometry& g, int own, int mate,
                const PairGeometry& p) {
  return tip_path(tooth_profile(d, g, own, g.gear[own].r_f), g.gear[own], g.gear[mate], p.a, p.alpha_wt,
                  p.j_n / std::cos(g.gear[own].beta_b));
}

// Shortens tips of internal gears until neither they nor those of their mates cut.
void shorten_to_spare_tips(const CylindricalDrive& d, CylindricalGeometry& g) {
  for_mates(d, g, [&](int own, int mate, const PairGeometry& p) {
    Toothing& ring = g.gear[own];
    if (!ring.internal || d.gears[own].r_a > 0) return;
    const double least = -kTouching * d.m_n;
    const TipPath in_mate = path_in(d, g, mate, own, p);
    TipPath in_own = path_in(d, g, own, mate, p);
    in_own.own.r_f = ring.r_form;  // shorter tips are no help in the fillet
    const auto clear = [&](double r_a) {
      in_own.own.r_a = r_a;
      return tip_keeps_off(in_mate, r_a, least) && tip_keeps_off(in_own, g.gear[mate].r_a, least);
    };
    if (!clear(ring.r_a)) ring.r_a = largest(ring.r_f, ring.r_a, clear);
  });
}

// The cutter with z_0 teeth; its tip radius is what is asked for, or the rack's as far as it fits.
Cutter shaper(const CylindricalDrive& d, const CylindricalGear& gear, const Toothing& t, int z_0) {
  Cutter c = cutter(t, z_0, 0);
  const double most = kTipArc * largest_tip_radius(c.teeth);
  c.rho = gear.cutter.rho_a0 >= 0 ? gear.cutter.rho_a0 * d.m_n : std::min(d.rack.rho_fP * d.m_n, most);
  return c;
}

bool has_tip(const CylindricalDrive& d, const Cutter& c) {
  return c.rho >= kLeastTipArc * d.m_n && c.rho <= kTipArc * largest_tip_radius(c.teeth) * (1 + 1e-12);
}

bool cuts_all(const CylindricalDrive& d, const Cutter& c, const Toothing& t) {
  return has_tip(d, c) && least_tip_radius(c, t) <= t.r_a && spares_flanks(c, t);
}

// The number of teeth nearest to the usual one, of a cutter that leaves whole flanks; 0: there is none.
int suitable_cutter(const CylindricalDrive& d, const CylindricalGear& gear, const Toothing& t) {
  for (int off = 0; off < t.z; ++off)
    for (int z_0 : {kUsualCutter - off, kUsualCutter + off})
      if (z_0 >= kLeastCutter && z_0 < t.z && cuts_all(d, shaper(d, gear, t, z_0), t)) return z_0;
  return 0;
}

void check_cutter_of(const CylindricalDrive& d, const CylindricalGear& gear, const Toothing& t,
                     const Cutter& c) {
  const double most = kTipArc * largest_tip_radius(c.teeth) / d.m_n, rho = c.rho / d.m_n;
  const int would_do = suitable_cutter(d, gear, t);
  const std::string remedy = would_do > 0 ? "; cutter_teeth: " + std::to_string(would_do) + " would do"
                                          : "; take a profile_shift nearer to 0, or shorter teeth";
  require(most >= kLeastTipArc, gear.name, ": the cutter of ", c.teeth.z, " teeth is pointed", remedy);
  require(has_tip(d, c), gear.name, ": cutter_tip_radius = ", rho, ": must be between ", kLeastTipArc,
          " and ", most, " modules for cutter_teeth = ", c.teeth.z);
  require(least_tip_radius(c, t) <= t.r_a, gear.name, ": the tip, diameter ", mm(2 * t.r_a),
          " mm, is deeper than the flanks of a cutter of ", c.teeth.z, " teeth: tip_diameter of at least ",
          mm(2 * least_tip_radius(c, t)), " mm is needed", remedy);
  require(spares_flanks(c, t), gear.name, ": a cutter of ", c.teeth.z, " teeth trims the tips, diameter ",
          mm(2 * t.r_a), " mm", remedy, ", or a larger tip_diameter");
}

void choose_cutter(const CylindricalDrive& d, CylindricalGeometry& g, int i) {
  const CylindricalGear& gear = d.gears[i];
  const Toothing& t = g.gear[i];
  const int z_0 = gear.cutter.z_0 > 0 ? gear.cutter.z_0 : suitable_cutter(d, gear, t);
  const Cutter c = shaper(d, gear, t, z_0 > 0 ? z_0 : std::min(kUsualCutter, t.z - 1));
  check_cutter_of(d, gear, t, c);
  g.cutter[i] = {c.teeth.z, c.rho / d.m_n};
}

// The remedy where backlash makes teeth too thin; empty where there is hardly any.
std::string backlash_remedy(const CylindricalDrive& d) {
  std::ostringstream text;
  if (d.j_n > kLeastTip * d.m_n)
    text << ", or less than backlash = " << mm(d.j_n) << " mm, half of which thins the teeth of each gear";
  return text.str();
}

void check_tip(const CylindricalDrive& d, const std::string& name, const Toothing& t) {
  const double shortest = t.internal ? t.r_f : std::max(t.r_f, t.r_b);
  if (t.internal)
    require(t.r_a < t.r_f && t.r_a > t.r_b, name, ": tip diameter ", mm(2 * t.r_a),
            " mm: must be between those of base and root, ", mm(2 * t.r_b), " and ", mm(2 * t.r_f), " mm");
  require(deeper(t, t.r_a) > deeper(t, shortest), name, ": tip diameter ", mm(2 * t.r_a),
          " mm: must be above those of root and base, ", mm(2 * shortest), " mm");
  const double least = kLeastTip * d.m_n;
  const auto thick = [&](double r) { return normal_thickness(t, r) >= least; };
  require(thick(t.r_a), name, ": the teeth are pointed, thinner than ", mm(least), " mm at the tip diameter ",
          mm(2 * t.r_a), " mm; tip_diameter of at ", t.internal ? "least " : "most ",
          mm(2 * largest(shortest, t.r_a, thick)), " mm would do", backlash_remedy(d));
}

void check_clearance(const CylindricalDrive& d, const CylindricalGeometry& g, int own, int mate, double a) {
  const Toothing& t = g.gear[own];
  const double limit = tip_at_clearance(t, g.gear[mate], a, 0);
  require(deeper(t, t.r_a) < deeper(t, limit), d.gears[own].name, ": the tip, diameter ", mm(2 * t.r_a),
          " mm, reaches the root of ", d.gears[mate].name, "; tip_diameter ",
          t.internal ? "above " : "below ", mm(2 * limit), " mm is needed");
}

// The tips of `mate` in the spaces of `own`.
void check_tip_path(const CylindricalDrive& d, const CylindricalGeometry& g, int own, int mate,
                    const PairGeometry& p) {
  const Toothing& other = g.gear[mate];
  const TipPath path = path_in(d, g, own, mate, p);
  const auto clear = [&](double r_a) { return tip_keeps_off(path, r_a, -kTouching * d.m_n); };
  if (clear(other.r_a)) return;
  const double shortest = other.internal ? other.r_f : other.r_b;
  fail(d.gears[mate].name, ": the tip, diameter ", mm(2 * other.r_a), " mm, cuts into the ",
       pair_sign(g.gear[own], other) > 0 ? "root of " : "root or the tips of ", d.gears[own].name,
       "; tip_diameter of at ", other.internal ? "least " : "most ",
       mm(2 * largest(shortest, other.r_a, clear)), " mm would do, or a larger profile_shift of ",
       d.gears[own].name);
}

bool leaves_flank(const Form& f, const Toothing& t) { return f.r_form > 0 && f.r_form < t.r_a; }

[[noreturn]] void refuse_protuberance(const CylindricalDrive& d, const CylindricalGeometry& g, int i) {
  const auto leaves = [&](double pr) {
    CylindricalDrive other = d;
    other.rack.pr = pr;
    return leaves_flank(form(generating_rack(other, g, i), g.gear[i]), g.gear[i]);
  };
  std::ostringstream remedy;
  if (leaves(0))
    remedy << "at most " << std::floor(largest(0, d.rack.pr, leaves) * 1e3) / 1e3 << " would do";
  else
    remedy << "a larger profile_shift or more teeth would do";
  fail(d.gears[i].name, ": rack_protuberance = ", d.rack.pr, ": its fillet leaves no flank; ", remedy.str());
}

}  // namespace

void shape_teeth(const CylindricalDrive& d, CylindricalGeometry& g) {
  const int n = static_cast<int>(d.gears.size());
  g.cutter.resize(d.gears.size());
  shorten_to_clearance(d, g);
  for (int i = 0; i < n; ++i) {
    if (d.gears[i].internal) continue;
    check_tip(d, d.gears[i].name, g.gear[i]);
    const Form f = form(generating_rack(d, g, i), g.gear[i]);
    if (!leaves_flank(f, g.gear[i])) refuse_protuberance(d, g, i);
    g.gear[i].r_form = f.r_form;
    g.gear[i].undercut = f.undercut;
  }
  shorten_to_form(d, g, true);
  for (int i = 0; i < n; ++i) {
    if (!d.gears[i].internal) continue;
    check_tip(d, d.gears[i].name, g.gear[i]);
    choose_cutter(d, g, i);
    g.gear[i].r_form = form_radius(generating_cutter(d, g, i), g.gear[i]);
    require(g.gear[i].r_form > g.gear[i].r_a, d.gears[i].name, ": the fillet reaches the tip, diameter ",
            mm(2 * g.gear[i].r_a), " mm; tip_diameter must be below ", mm(2 * g.gear[i].r_form), " mm");
  }
  shorten_to_form(d, g, false);
  shorten_to_spare_tips(d, g);
}

void check_tips(const CylindricalDrive& d, CylindricalGeometry& g) {
  for (std::size_t i = 0; i < d.gears.size(); ++i) check_tip(d, d.gears[i].name, g.gear[i]);
  for (std::size_t i = 0; i < d.pairs.size(); ++i) {
    PairGeometry& p = g.pair[i];
    const int gear[] = {d.pairs[i].first, d.pairs[i].second};
    for (int k : {0, 1}) {
      check_clearance(d, g, gear[k], gear[1 - k], p.a);
      p.c[k] = deeper(g.gear[gear[k]], tip_at_clearance(g.gear[gear[k]], g.gear[gear[1 - k]], p.a, 0)) -
               deeper(g.gear[gear[k]], g.gear[gear[k]].r_a);
    }
    for (int k : {0, 1}) check_tip_path(d, g, gear[k], gear[1 - k], p);
  }
}

}  // namespace elastogear::gear
