#include "elastogear/gear/cylindrical.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <sstream>

#include "elastogear/base/error.h"
#include "gear/cylindrical/derivation.h"
#include "gear/cylindrical/tip_path.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;

constexpr double kLeastContactRatio = 1;

// Without thinning, without shorter tips. ISO 21771 counts the diameters of internal gears below 0.
Toothing toothing(const CylindricalDrive& d, int i, double beta) {
  const CylindricalGear& gear = d.gears[i];
  Toothing t{.z = gear.z, .internal = gear.internal};
  t.r = d.m_n * gear.z / (2 * std::cos(beta));
  t.alpha_t = std::atan(std::tan(d.rack.alpha_n) / std::cos(beta));
  t.r_b = t.r * std::cos(t.alpha_t);
  t.beta_b = std::asin(std::sin(beta) * std::cos(d.rack.alpha_n));
  t.p = t.r / std::tan(beta);  // infinite for spurs
  t.r_f = t.r + t.sign() * (gear.x - d.rack.h_fP) * d.m_n;
  t.r_a = gear.r_a > 0 ? gear.r_a : t.r + t.sign() * (gear.x + d.rack.h_aP) * d.m_n;
  t.theta_1 = pi / 2;
  return t;
}

double unthinned(const CylindricalDrive& d, int i) {
  return d.m_n * (pi / 2 + 2 * d.gears[i].x * std::tan(d.rack.alpha_n));
}

// Helical mates have opposite hands, in an internal pair the same one.
std::vector<double> hands(const CylindricalDrive& d) {
  std::vector<double> hand(d.gears.size(), 0);
  hand[0] = 1;
  for (const GearPair& pair : d.pairs) {
    const bool same = d.gears[pair.first].internal || d.gears[pair.second].internal;
    const double of_second = (same ? 1 : -1) * hand[pair.first];
    require(hand[pair.second] * of_second >= 0 || d.beta == 0, "pair ", pair_name(d, pair),
            ": both gears have the hand of helix that earlier pairs give them, and do not mesh");
    hand[pair.second] = of_second;
  }
  return hand;
}

// With all checks but that of contact ratios.
CylindricalGeometry solved(const CylindricalDrive& d) {
  check_design(d);
  CylindricalGeometry g;
  g.p_bn = pi * d.m_n * std::cos(d.rack.alpha_n);
  const std::vector<double> hand = hands(d);
  for (std::size_t i = 0; i < d.gears.size(); ++i) {
    const int k = static_cast<int>(i);
    g.gear.push_back(toothing(d, k, hand[i] * d.beta));
    g.s_n.push_back(unthinned(d, k));
    g.gear[i].psi_b = half_angle_at_base(d, g.gear[i], g.s_n[i]);
    g.blank.push_back(completed(d, d.gears[i], g.gear[i]));
  }
  place_gears(d, g);
  thin_teeth(d, g);
  shape_teeth(d, g);
  check_tips(d, g);
  for (std::size_t i = 0; i < d.pairs.size(); ++i) set_path_of_contact(d, d.pairs[i], g, g.pair[i]);
  check_loops(d, g);
  return g;
}

double contact_ratio(const PairGeometry& p) { return p.epsilon_alpha + p.epsilon_beta; }

bool reaches_contact_ratio(const CylindricalDrive& d, std::size_t pair) {
  try {
    return contact_ratio(solved(d).pair[pair]) >= kLeastContactRatio;
  } catch (const Error&) {
    return false;
  }
}

constexpr double kShiftStep = 0.01;
constexpr int kShiftSteps = 100;

// The profile shift of a gear, a number of steps from where it is.
double shifted(const CylindricalDrive& d, int gear, int steps) {
  return std::round(d.gears[static_cast<std::size_t>(gear)].x / kShiftStep + steps) * kShiftStep +
         0.0;  // no -0
}

// "; profile_shift of pinion of at least 0.31 would do", the nearest value in steps of a hundredth; empty
// where none of either gear does.
std::string shift_that_would_do(const CylindricalDrive& d, std::size_t pair) {
  for (int i = 1; i <= kShiftSteps; ++i)
    for (int gear : {d.pairs[pair].first, d.pairs[pair].second})
      for (int sign : {1, -1}) {
        CylindricalDrive other = d;
        CylindricalGear& own = other.gears[static_cast<std::size_t>(gear)];
        own.x = shifted(d, gear, sign * i);
        if (!reaches_contact_ratio(other, pair)) continue;
        std::ostringstream text;
        text << "; profile_shift of " << own.name << (sign > 0 ? " of at least " : " of at most ") << own.x
             << " would do";
        return text.str();
      }
  return "";
}

// Both gears of a pair, shifted by numbers of steps from where they are.
CylindricalDrive with_shifts(const CylindricalDrive& d, std::size_t pair, const std::array<int, 2>& steps) {
  CylindricalDrive other = d;
  const std::array<int, 2> gear{d.pairs[pair].first, d.pairs[pair].second};
  for (std::size_t k : {0, 1})
    other.gears[static_cast<std::size_t>(gear[k])].x = shifted(d, gear[k], steps[k]);
  return other;
}

// Both gears shifted by the same or by opposite amounts.
std::optional<CylindricalDrive> equal_shifts(const CylindricalDrive& d, std::size_t pair) {
  for (int i = 1; i <= kShiftSteps; ++i)
    for (int sign : {1, -1})
      for (int mate : {-1, 1}) {
        const CylindricalDrive other = with_shifts(d, pair, {sign * i, sign * mate * i});
        if (reaches_contact_ratio(other, pair)) return other;
      }
  return {};
}

// Both gears shifted by any amounts in steps of a tenth, of which the larger one is as small as it can be,
// and then both or one taken back by hundredths.
std::optional<CylindricalDrive> any_shifts(const CylindricalDrive& d, std::size_t pair) {
  constexpr int kCoarse = 10, kMost = 15;  // steps; coarse ones
  const auto does = [&](const std::array<int, 2>& steps) {
    return reaches_contact_ratio(with_shifts(d, pair, steps), pair);
  };
  const auto taken_back = [&](std::array<int, 2> steps) {
    constexpr std::array<std::array<int, 2>, 3> kWays{{{1, 1}, {1, 0}, {0, 1}}};
    const auto back = [&](const std::array<int, 2>& way) {
      std::array<int, 2> next = steps;
      for (std::size_t k : {0, 1}) next[k] -= std::clamp(next[k], -way[k], way[k]);
      if (next == steps || !does(next)) return false;
      steps = next;
      return true;
    };
    for (bool moved = true; moved;) moved = std::any_of(kWays.begin(), kWays.end(), back);
    return with_shifts(d, pair, steps);
  };
  for (int most = 1; most <= kMost; ++most)
    for (int i = -most; i <= most; ++i)
      for (int j = -most; j <= most; ++j)
        if (std::max(std::abs(i), std::abs(j)) == most && does({kCoarse * i, kCoarse * j}))
          return taken_back({kCoarse * i, kCoarse * j});
  return {};
}

// "; profile_shift 0.59 of pinion and 0.05 of wheel would do"; empty where none does.
std::string shifts_that_would_do(const CylindricalDrive& d, std::size_t pair) {
  std::optional<CylindricalDrive> other = equal_shifts(d, pair);
  if (!other) other = any_shifts(d, pair);
  if (!other) return "";
  const CylindricalGear &first = other->gears[static_cast<std::size_t>(d.pairs[pair].first)],
                        &second = other->gears[static_cast<std::size_t>(d.pairs[pair].second)];
  std::ostringstream text;
  text << "; profile_shift " << first.x << " of " << first.name << " and " << second.x << " of "
       << second.name << " would do";
  return text.str();
}

}  // namespace

double half_angle_at_base(const CylindricalDrive& d, const Toothing& t, double s_n) {
  return s_n / (d.m_n * t.z) + t.sign() * involute(t.alpha_t);
}

BasicRack basic_rack(const std::string& name) {
  if (name == "A") return {};
  if (name == "B") return {.rho_fP = 0.30};
  if (name == "C") return {.rho_fP = 0.25};
  if (name == "D") return {.h_fP = 1.4, .rho_fP = 0.39};
  fail("there is no basic rack '", name, "'; those of ISO 53 are A, B, C, D");
}

CylindricalGeometry derive(const CylindricalDrive& d) {
  CylindricalGeometry g = solved(d);
  for (std::size_t i = 0; i < d.pairs.size(); ++i) {
    if (contact_ratio(g.pair[i]) >= kLeastContactRatio) continue;
    const bool external = pair_sign(g.gear[d.pairs[i].first], g.gear[d.pairs[i].second]) > 0;
    const std::string remedy = shift_that_would_do(d, i);
    fail("pair ", pair_name(d, d.pairs[i]), ": the contact ratio is ", contact_ratio(g.pair[i]),
         ", at least ", kLeastContactRatio, " is needed: take tips that reach deeper, a ",
         external ? "smaller" : "larger", " centre distance, or profile shifts with less undercut",
         remedy.empty() ? shifts_that_would_do(d, i) : remedy);
  }
  return g;
}

}  // namespace elastogear::gear
