#include "elastogear/gear/cylindrical.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/cylindrical/generating_rack.h"
#include "gear/cylindrical/tip_path.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;

constexpr double kMostModule = 0.5;  // m: larger ones are given in a wrong unit
constexpr int kLeastTeeth = 5, kMostTeeth = 1000;
constexpr double kMostHelix = pi / 4, kMostPressureAngle = pi / 4;
constexpr double kLeastTip = 0.1;  // modules: thinner teeth count as pointed
constexpr double kLeastContactRatio = 1;
constexpr double kBore = 0.4;                // root diameters
constexpr double kRim = 2.5, kLeastRim = 1;  // modules, of a rim without a choice, and of any
constexpr double kDegree = pi / 180;
constexpr double kMm = 1e-3;
constexpr double kRounding = 0.01;  // modules of overlap, as profile shifts of few digits leave
constexpr double kTouching = 1e-6;  // modules, by which a tip may be off the involute
constexpr int kHalvings = 60;

double mm(double length) { return length / kMm; }

// The largest value in [low, high] for which `holds`, which is true at low.
template <class Holds>
double largest(double low, double high, Holds holds) {
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return low;
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
  require(d.rack.h_aP > 0 && d.rack.h_fP > d.rack.h_aP && d.rack.rho_fP > 0, "basic rack: addendum ",
          d.rack.h_aP, ", dedendum ", d.rack.h_fP, " and fillet radius ", d.rack.rho_fP,
          " must be positive, and the dedendum above the addendum");
  require(!d.gears.empty(), "a drive needs gears");
  for (const CylindricalGear& gear : d.gears) {
    require(gear.z >= kLeastTeeth && gear.z <= kMostTeeth, gear.name, ": teeth = ", gear.z, ": must be ",
            kLeastTeeth, " to ", kMostTeeth);
    require(std::isfinite(gear.x) && std::abs(gear.x) <= 2, gear.name, ": profile_shift = ", gear.x,
            ": must be between -2 and 2 (modules)");
    require(std::isfinite(gear.blank.face_width) && gear.blank.face_width > 0, gear.name,
            ": face_width = ", mm(gear.blank.face_width), " mm: must be positive");
  }
}

void check_pairs(const CylindricalDrive& d) {
  const int n = static_cast<int>(d.gears.size());
  std::vector<char> placed(d.gears.size(), 0);
  placed[0] = 1;
  for (const GearPair& pair : d.pairs) {
    require(pair.first >= 0 && pair.first < n && pair.second >= 0 && pair.second < n,
            "a pair names a gear that is not there");
    const std::string name = d.gears[pair.first].name + ":" + d.gears[pair.second].name;
    require(placed[pair.first] && !placed[pair.second], "pair ", name,
            ": its first gear must be the first of all or the second of an earlier pair, and its second one "
            "in no "
            "pair before");
    placed[pair.second] = 1;
  }
  for (int i = 0; i < n; ++i) require(placed[i], "gear ", d.gears[i].name, " is in no pair");
}

// The tool's tip must fit into the space between its flanks.
void check_rack(const CylindricalDrive& d) {
  const double alpha = d.rack.alpha_n;
  const double room = pi / 4 - d.rack.h_fP * std::tan(alpha);  // half the tip's land without rounding
  require(room > 0, "basic rack: dedendum ", d.rack.h_fP,
          " is too deep for pressure_angle = ", alpha / kDegree, " deg: at most ", pi / 4 / std::tan(alpha));
  const double most = room / ((1 - std::sin(alpha)) / std::cos(alpha));
  require(d.rack.rho_fP <= most, "basic rack: fillet radius ", d.rack.rho_fP, " does not fit, at most ", most,
          " with pressure_angle = ", alpha / kDegree, " deg and dedendum ", d.rack.h_fP);
}

// Without thinning, without its tip.
Toothing toothing(const CylindricalDrive& d, int i, double beta) {
  const CylindricalGear& gear = d.gears[i];
  Toothing t{.z = gear.z};
  t.r = d.m_n * gear.z / (2 * std::cos(beta));
  t.alpha_t = std::atan(std::tan(d.rack.alpha_n) / std::cos(beta));
  t.r_b = t.r * std::cos(t.alpha_t);
  t.beta_b = std::asin(std::sin(beta) * std::cos(d.rack.alpha_n));
  t.p = t.r / std::tan(beta);  // infinite for spurs
  t.r_f = t.r + (gear.x - d.rack.h_fP) * d.m_n;
  t.r_a = gear.r_a > 0 ? gear.r_a : t.r + (gear.x + d.rack.h_aP) * d.m_n;
  t.theta_1 = pi / 2;
  return t;
}

double unthinned(const CylindricalDrive& d, int i) {
  return d.m_n * (pi / 2 + 2 * d.gears[i].x * std::tan(d.rack.alpha_n));
}

double half_angle_at_base(const CylindricalDrive& d, const Toothing& t, double s_n) {
  return s_n / (d.m_n * t.z) + involute(t.alpha_t);
}

// Normal backlash of a pair at the working pressure angle alpha_wt: what the teeth leave of the base pitch.
double backlash(const Toothing& t_1, const Toothing& t_2, double alpha_wt) {
  const double pitch = 2 * pi * t_1.r_b * std::cos(t_1.beta_b) / t_1.z, inv = involute(alpha_wt);
  const auto thickness = [&](const Toothing& t) { return 2 * t.r_b * std::cos(t.beta_b) * (t.psi_b - inv); };
  return pitch - thickness(t_1) - thickness(t_2);
}

std::string pair_name(const CylindricalDrive& d, const GearPair& pair) {
  return d.gears[pair.first].name + ":" + d.gears[pair.second].name;
}

// Working pressure angle at which the teeth have no backlash.
double tight_angle(const CylindricalDrive& d, const GearPair& pair, const Toothing& t_1,
                   const Toothing& t_2) {
  const double inv = (t_1.r_b * t_1.psi_b + t_2.r_b * t_2.psi_b - pi * t_1.r_b / t_1.z) / (t_1.r_b + t_2.r_b);
  require(inv > 0, "pair ", pair_name(d, pair), ": profile shifts of ", d.gears[pair.first].x, " and ",
          d.gears[pair.second].x, " leave no working pressure angle; their sum must be above ",
          -involute(t_1.alpha_t) * (t_1.z + t_2.z) / (2 * std::tan(d.rack.alpha_n)));
  return largest(0, pi / 2, [&](double alpha) { return involute(alpha) <= inv; });
}

// Centre distance, working pressure angle and the backlash that teeth without thinning have.
PairGeometry placed(const CylindricalDrive& d, const GearPair& pair, const CylindricalGeometry& g) {
  const Toothing &t_1 = g.gear[pair.first], &t_2 = g.gear[pair.second];
  const double tight = tight_angle(d, pair, t_1, t_2), base = t_1.r_b + t_2.r_b;
  PairGeometry p;
  p.a = pair.a > 0 ? pair.a : base / std::cos(tight);
  require(p.a > base, "pair ", pair_name(d, pair), ": centre_distance = ", mm(p.a),
          " mm: must be above the sum of the base radii, ", mm(base), " mm");
  p.alpha_wt = pair.a > 0 ? std::acos(base / p.a) : tight;
  p.j_n = pair.a > 0 ? backlash(t_1, t_2, p.alpha_wt) : 0;
  require(p.j_n >= -kRounding * d.m_n, "pair ", pair_name(d, pair), ": centre_distance = ", mm(p.a),
          " mm: the teeth overlap by ", mm(-p.j_n), " mm; at least ", mm(base / std::cos(tight)),
          " mm is needed with these profile shifts");
  return p;
}

// Normal backlash that thinner teeth have to give a pair.
double thinning(const CylindricalDrive& d, const GearPair& pair, const PairGeometry& p) {
  if (d.j_n < 0) return std::max(0.0, kBacklash * d.m_n - p.j_n);
  require(d.j_n >= p.j_n, "pair ", pair_name(d, pair), ": backlash = ", mm(d.j_n),
          " mm: the centre distance leaves ", mm(p.j_n), " mm; ask for at least that, or give a smaller one");
  return d.j_n - p.j_n;
}

void thin_teeth(const CylindricalDrive& d, CylindricalGeometry& g) {
  std::vector<double> by(d.gears.size(), 0);
  for (std::size_t i = 0; i < d.pairs.size(); ++i)
    for (int gear : {d.pairs[i].first, d.pairs[i].second})
      by[gear] = std::max(by[gear], thinning(d, d.pairs[i], g.pair[i]) / 2);
  for (std::size_t i = 0; i < d.gears.size(); ++i) {
    g.s_n[i] -= by[i] / std::cos(d.rack.alpha_n);
    g.gear[i].psi_b = half_angle_at_base(d, g.gear[i], g.s_n[i]);
  }
  for (std::size_t i = 0; i < d.pairs.size(); ++i)
    g.pair[i].j_n = backlash(g.gear[d.pairs[i].first], g.gear[d.pairs[i].second], g.pair[i].alpha_wt);
}

void shorten_tips(const CylindricalDrive& d, CylindricalGeometry& g) {
  for (std::size_t i = 0; i < d.pairs.size(); ++i) {
    const int gear[] = {d.pairs[i].first, d.pairs[i].second};
    for (int k : {0, 1}) {
      Toothing& t = g.gear[gear[k]];
      const double most = g.pair[i].a - g.gear[gear[1 - k]].r_f - kLeastClearance * d.m_n;
      if (d.gears[gear[k]].r_a <= 0) t.r_a = std::min(t.r_a, most);
    }
  }
}

void check_tip(const CylindricalDrive& d, const std::string& name, const Toothing& t) {
  require(t.r_a > t.r_f && t.r_a > t.r_b, name, ": tip diameter ", mm(2 * t.r_a),
          " mm: must be above those of root and base, ", mm(2 * std::max(t.r_f, t.r_b)), " mm");
  const double least = kLeastTip * d.m_n;
  const auto thick = [&](double r) { return 2 * r * psi(t, r) * d.m_n * t.z / (2 * t.r) >= least; };
  require(thick(t.r_a), name, ": the teeth are pointed, thinner than ", mm(least), " mm at the tip diameter ",
          mm(2 * t.r_a), " mm; tip_diameter of at most ",
          mm(2 * largest(std::max(t.r_f, t.r_b), t.r_a, thick)), " mm would do");
}

// Along the line of action from the point nearest to a gear's own axis, where the mate's tip leaves its
// flank, or where the flank ends.
double start_of_contact(const Toothing& t, const Toothing& mate, double action) {
  return std::max(action - along_action(mate, mate.r_a), along_action(t, t.r_form));
}

void check_clearances(const CylindricalDrive& d, const GearPair& pair, const CylindricalGeometry& g,
                      PairGeometry& p) {
  const int gear[] = {pair.first, pair.second};
  for (int k : {0, 1}) {
    const Toothing &t = g.gear[gear[k]], &mate = g.gear[gear[1 - k]];
    p.c[k] = p.a - t.r_a - mate.r_f;
    require(p.c[k] > 0, d.gears[gear[k]].name, ": the tip, diameter ", mm(2 * t.r_a),
            " mm, reaches the root of ", d.gears[gear[1 - k]].name, "; tip_diameter below ",
            mm(2 * (p.a - mate.r_f)), " mm is needed");
  }
}

// Tips that cut into roots, and where contact begins.
void check_tip_paths(const CylindricalDrive& d, const GearPair& pair, CylindricalGeometry& g,
                     const PairGeometry& p) {
  const int gear[] = {pair.first, pair.second};
  for (int k : {0, 1}) {
    Toothing& t = g.gear[gear[k]];
    const Toothing& mate = g.gear[gear[1 - k]];
    const std::string &own = d.gears[gear[k]].name, &other = d.gears[gear[1 - k]].name;
    const TipPath path =
        tip_path(generated_profile(generating_rack(d, g, gear[k]), t, t.r_f), t, mate, p.a, p.alpha_wt);
    const auto clear = [&](double r_a) { return tip_gap(path, r_a) >= -kTouching * d.m_n; };
    require(clear(mate.r_a), other, ": the tip, diameter ", mm(2 * mate.r_a), " mm, cuts into the root of ",
            own, "; tip_diameter of at most ", mm(2 * largest(mate.r_b, mate.r_a, clear)),
            " mm would do, or a larger profile_shift of ", own);
    const double start = std::hypot(t.r_b, start_of_contact(t, mate, p.a * std::sin(p.alpha_wt)));
    t.r_start = t.r_start > 0 ? std::min(t.r_start, start) : start;
  }
}

void set_contact_ratio(const CylindricalDrive& d, const GearPair& pair, const CylindricalGeometry& g,
                       PairGeometry& p) {
  const Toothing &t_1 = g.gear[pair.first], &t_2 = g.gear[pair.second];
  const double action = p.a * std::sin(p.alpha_wt);
  const double path = action - start_of_contact(t_1, t_2, action) - start_of_contact(t_2, t_1, action);
  const double width = std::min(g.blank[pair.first].face_width, g.blank[pair.second].face_width);
  const double p_bt = 2 * pi * t_1.r_b / t_1.z;
  p.epsilon_alpha = path / p_bt;
  p.epsilon_beta = width * std::sin(std::abs(d.beta)) / (pi * d.m_n);
  require(p.epsilon_alpha + p.epsilon_beta >= kLeastContactRatio, "pair ", pair_name(d, pair),
          ": the contact ratio is ", p.epsilon_alpha + p.epsilon_beta, ", at least ", kLeastContactRatio,
          " is needed: take larger tip diameters, a smaller centre distance, or profile shifts with less "
          "undercut");
}

Blank completed(const CylindricalDrive& d, const CylindricalGear& gear, const Toothing& t) {
  Blank b = gear.blank;
  const double root = 2 * t.r_f, most = root - 2 * kLeastRim * d.m_n;
  if (b.bore == 0) b.bore = std::min(kBore * root, most);
  if (b.rim_diameter == 0) {
    b.rim_diameter = root - 2 * kRim * d.m_n;
    if (b.rim_diameter < b.bore + kRim * d.m_n) b.rim_diameter = b.bore;
    if (b.has_web()) b.rim_diameter = std::max(b.rim_diameter, b.web_diameter + kLeastRim * d.m_n);
  }
  require(b.bore > 0 && b.bore <= most, gear.name, ": bore = ", mm(b.bore),
          " mm: must be positive and at most ", mm(most), " mm, a module below the root diameter ", mm(root),
          " mm on each side");
  require(b.rim_diameter >= b.bore && b.rim_diameter <= most, gear.name,
          ": rim_diameter = ", mm(b.rim_diameter), " mm: must be between the bore, ", mm(b.bore), " mm, and ",
          mm(most), " mm");
  if (!b.has_web()) return b;
  require(b.bore < b.hub_diameter && b.hub_diameter < b.web_diameter && b.web_diameter < b.rim_diameter,
          gear.name, ": bore ", mm(b.bore), ", hub_diameter ", mm(b.hub_diameter), ", web_diameter ",
          mm(b.web_diameter), " and rim_diameter ", mm(b.rim_diameter), " mm must increase in this order");
  if (b.hub_width == 0) b.hub_width = b.face_width;
  require(b.web_width > 0 && b.web_width <= std::min(b.hub_width, b.face_width), gear.name,
          ": web_width = ", mm(b.web_width), " mm: must be positive, at most hub_width ", mm(b.hub_width),
          " mm and face_width ", mm(b.face_width), " mm");
  return b;
}

}  // namespace

BasicRack basic_rack(const std::string& name) {
  if (name == "A") return {};
  if (name == "B") return {.rho_fP = 0.30};
  if (name == "C") return {.rho_fP = 0.25};
  if (name == "D") return {.h_fP = 1.4, .rho_fP = 0.39};
  fail("there is no basic rack '", name, "'; those of ISO 53 are A, B, C, D");
}

CylindricalGeometry derive(const CylindricalDrive& d) {
  check_numbers(d);
  check_pairs(d);
  check_rack(d);
  CylindricalGeometry g;
  g.p_bn = pi * d.m_n * std::cos(d.rack.alpha_n);
  const int n = static_cast<int>(d.gears.size());
  std::vector<double> hand(d.gears.size(), 1);
  for (const GearPair& pair : d.pairs) hand[pair.second] = -hand[pair.first];
  for (int i = 0; i < n; ++i) {
    g.gear.push_back(toothing(d, i, hand[i] * d.beta));
    g.s_n.push_back(unthinned(d, i));
    g.gear[i].psi_b = half_angle_at_base(d, g.gear[i], g.s_n[i]);
    g.blank.push_back(completed(d, d.gears[i], g.gear[i]));
  }
  g.axis.assign(d.gears.size(), Eigen::Vector2d::Zero());
  for (const GearPair& pair : d.pairs) {
    const PairGeometry p = placed(d, pair, g);
    g.pair.push_back(p);
    g.axis[pair.second] =
        g.axis[pair.first] + p.a * Eigen::Vector2d(std::cos(pair.direction), std::sin(pair.direction));
  }
  thin_teeth(d, g);
  shorten_tips(d, g);
  for (int i = 0; i < n; ++i) {
    check_tip(d, d.gears[i].name, g.gear[i]);
    const Form f = form(generating_rack(d, g, i), g.gear[i]);
    g.gear[i].r_form = f.r_form;
    g.undercut.push_back(f.undercut);
  }
  for (std::size_t i = 0; i < d.pairs.size(); ++i) {
    check_clearances(d, d.pairs[i], g, g.pair[i]);
    check_tip_paths(d, d.pairs[i], g, g.pair[i]);
    set_contact_ratio(d, d.pairs[i], g, g.pair[i]);
  }
  return g;
}

}  // namespace elastogear::gear
