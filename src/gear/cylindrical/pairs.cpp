#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/cylindrical/derivation.h"
#include "gear/cylindrical/tip_path.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;

constexpr double kRounding = 0.01;  // modules of overlap, as profile shifts of few digits leave

// Normal backlash of a pair at the working pressure angle alpha_wt: what the teeth leave of the base pitch.
double backlash(const Toothing& t_1, const Toothing& t_2, double alpha_wt) {
  const double pitch = 2 * pi * t_1.r_b * std::cos(t_1.beta_b) / t_1.z, inv = involute(alpha_wt);
  const auto thickness = [&](const Toothing& t) {
    return 2 * t.r_b * std::cos(t.beta_b) * (t.psi_b - t.sign() * inv);
  };
  return pitch - thickness(t_1) - thickness(t_2);
}

// Sum of the base radii; of an internal pair their difference.
double base_sum(const Toothing& t_1, const Toothing& t_2) {
  return std::abs(t_1.sign() * t_1.r_b + t_2.sign() * t_2.r_b);
}

// Working pressure angle at which the teeth have no backlash.
double tight_angle(const CylindricalDrive& d, const GearPair& pair, const Toothing& t_1,
                   const Toothing& t_2) {
  const double inv = (t_1.r_b * t_1.psi_b + t_2.r_b * t_2.psi_b - pi * t_1.r_b / t_1.z) /
                     (t_1.sign() * t_1.r_b + t_2.sign() * t_2.r_b);
  const double z = t_1.sign() * t_1.z + t_2.sign() * t_2.z;
  require(inv > 0, "pair ", pair_name(d, pair), ": profile shifts of ", d.gears[pair.first].x, " and ",
          d.gears[pair.second].x, " leave no working pressure angle; their sum must be ",
          z > 0 ? "above " : "below ", -involute(t_1.alpha_t) * z / (2 * std::tan(d.rack.alpha_n)));
  return largest(0, pi / 2, [&](double alpha) { return involute(alpha) <= inv; });
}

// The sum of the profile shifts with which teeth have no backlash at alpha_wt.
double tight_sum(const CylindricalDrive& d, const Toothing& t_1, const Toothing& t_2, double alpha_wt) {
  return (involute(alpha_wt) - involute(t_1.alpha_t)) * (t_1.sign() * t_1.z + t_2.sign() * t_2.z) /
         (2 * std::tan(d.rack.alpha_n));
}

// Working pressure angle at the centre distance a (m, 0: without backlash), and the backlash that teeth
// without thinning have.
PairGeometry placed(const CylindricalDrive& d, const GearPair& pair, const CylindricalGeometry& g, double a) {
  const Toothing &t_1 = g.gear[pair.first], &t_2 = g.gear[pair.second];
  const double tight = tight_angle(d, pair, t_1, t_2), base = base_sum(t_1, t_2);
  const bool internal = pair_sign(t_1, t_2) < 0;
  PairGeometry p;
  p.a = a > 0 ? a : base / std::cos(tight);
  require(p.a > base, "pair ", pair_name(d, pair), ": centre_distance = ", mm(p.a), " mm: must be above the ",
          internal ? "difference" : "sum", " of the base radii, ", mm(base), " mm");
  p.alpha_wt = a > 0 ? std::acos(base / p.a) : tight;
  p.j_n = a > 0 ? backlash(t_1, t_2, p.alpha_wt) : 0;
  require(p.j_n >= -kRounding * d.m_n, "pair ", pair_name(d, pair), ": centre_distance = ", mm(p.a),
          " mm: the teeth overlap by ", mm(-p.j_n), " mm; at ", internal ? "most " : "least ",
          mm(base / std::cos(tight)),
          " mm is needed with these profile shifts, or a sum of profile shifts of ", "at most ",
          tight_sum(d, t_1, t_2, p.alpha_wt));
  return p;
}

Eigen::Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

// Normal backlash that thinner teeth have to give a pair.
double thinning(const CylindricalDrive& d, const GearPair& pair, const PairGeometry& p) {
  if (d.j_n < 0) return std::max(0.0, kBacklash * d.m_n - p.j_n);
  require(
      d.j_n >= p.j_n, "pair ", pair_name(d, pair), ": backlash = ", mm(d.j_n),
      " mm: the centre distance leaves ", mm(p.j_n), " mm; ask for at least that, or give a ",
      pair_sign({.internal = d.gears[pair.first].internal}, {.internal = d.gears[pair.second].internal}) > 0
          ? "smaller one"
          : "larger one");
  return d.j_n - p.j_n;
}

// Along the own line of action, where the mate's tip leaves the flank, or where the flank ends.
double root_end(const Toothing& own, const Toothing& mate, double action) {
  const double tip = along_own(own, mate, action, along_action(mate, mate.r_a));
  const double form = along_action(own, own.r_form);
  return own.internal ? std::min(tip, form) : std::max(tip, form);
}

void set_start(Toothing& t, double xi) {
  const double start = std::hypot(t.r_b, xi);
  t.r_start = t.r_start == 0 ? start : t.sign() * std::min(t.sign() * t.r_start, t.sign() * start);
}

}  // namespace

void place_gears(const CylindricalDrive& d, CylindricalGeometry& g) {
  std::vector<char> has_place(d.gears.size(), 0);
  g.axis.assign(d.gears.size(), Eigen::Vector2d::Zero());
  has_place[0] = 1;
  for (const GearPair& pair : d.pairs) {
    const bool known = has_place[pair.second] || pair.coaxial >= 0;
    if (!has_place[pair.second] && known) g.axis[pair.second] = g.axis[pair.coaxial];
    const Eigen::Vector2d line = g.axis[pair.second] - g.axis[pair.first];
    require(!known || line.norm() > 0, "pair ", pair_name(d, pair), ": both gears have the same axis");
    PairGeometry p = placed(d, pair, g, known ? line.norm() : pair.a);
    p.direction = known ? std::atan2(line[1], line[0]) : pair.direction;
    if (!known) g.axis[pair.second] = g.axis[pair.first] + p.a * unit(p.direction);
    has_place[pair.second] = 1;
    g.pair.push_back(p);
  }
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

void set_path_of_contact(const CylindricalDrive& d, const GearPair& pair, CylindricalGeometry& g,
                         PairGeometry& p) {
  Toothing &t_1 = g.gear[pair.first], &t_2 = g.gear[pair.second];
  const double action = p.a * std::sin(p.alpha_wt), xi_2 = root_end(t_2, t_1, action);
  p.path[0] = root_end(t_1, t_2, action);
  p.path[1] = along_own(t_1, t_2, action, xi_2);
  set_start(t_1, p.path[0]);
  set_start(t_2, xi_2);
  const double width = std::min(g.blank[pair.first].face_width, g.blank[pair.second].face_width);
  p.epsilon_alpha = t_1.sign() * (p.path[1] - p.path[0]) / (2 * pi * t_1.r_b / t_1.z);
  p.epsilon_beta = width * std::sin(std::abs(d.beta)) / (pi * d.m_n);
}

}  // namespace elastogear::gear
