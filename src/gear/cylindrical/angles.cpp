#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/cylindrical/derivation.h"
#include "gear/cylindrical/tip_path.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;

constexpr double kMeeting = 1e-4;  // modules, by which flanks of a closed loop may miss each other

// rad, from the first axis to the pitch point, which lies between the axes, or beyond that of the inner gear.
double to_pitch_point(const CylindricalGeometry& g, const GearPair& pair, const PairGeometry& p) {
  return p.direction + (g.gear[pair.second].internal ? pi : 0);
}

// The angle of the second gear at which it touches the first one, which stands at angle_1 and turns in the
// sense `turns`. In pitches from the pitch point the angles of two mates add up to half a pitch (internal:
// differ by it) where a tooth of one stands in the middle of a space of the other.
double touching(const CylindricalGeometry& g, const GearPair& pair, const PairGeometry& p, double angle_1,
                int turns) {
  const Toothing &t_1 = g.gear[pair.first], &t_2 = g.gear[pair.second];
  const double both = pair_sign(t_1, t_2), from_1 = to_pitch_point(g, pair, p);
  const double from_2 = both > 0 ? from_1 + pi : from_1;
  const double pitches = (angle_1 + pi / 2 - from_1) * t_1.z / (2 * pi);
  const double closing = p.j_n / (2 * t_2.r_b * std::cos(t_2.beta_b));
  return (0.5 - both * pitches) * 2 * pi / t_2.z + from_2 - pi / 2 + both * turns * closing;
}

struct Stand {
  std::vector<double> angle;  // rad
  std::vector<int> turns;     // > 0: counter-clockwise
};

Stand stand(const CylindricalDrive& d, const CylindricalGeometry& g, double roll, bool drive_side) {
  Stand s{std::vector<double>(d.gears.size(), 0), std::vector<int>(d.gears.size(), 0)};
  s.turns[0] = drive_side ? 1 : -1;
  if (!d.pairs.empty())
    s.angle[0] = to_pitch_point(g, d.pairs[0], g.pair[0]) - pi / 2 + 2 * pi * roll / d.gears[0].z;
  for (std::size_t i = 0; i < d.pairs.size(); ++i) {
    const auto [first, second] = std::pair(d.pairs[i].first, d.pairs[i].second);
    if (s.turns[second] != 0) continue;
    s.angle[second] = touching(g, d.pairs[i], g.pair[i], s.angle[first], s.turns[first]);
    s.turns[second] = pair_sign(g.gear[first], g.gear[second]) > 0 ? -s.turns[first] : s.turns[first];
  }
  return s;
}

// rad, by which the second gear stands beyond the angle at which it touches the first one.
double beyond_touch(const CylindricalGeometry& g, const GearPair& pair, const PairGeometry& p,
                    const Stand& s) {
  const double expected = touching(g, pair, p, s.angle[pair.first], s.turns[pair.first]);
  return std::remainder(s.angle[pair.second] - expected, 2 * pi / g.gear[pair.second].z);
}

// The pair that gave a gear its place.
const GearPair* placing(const CylindricalDrive& d, int gear) {
  for (const GearPair& pair : d.pairs)
    if (pair.second == gear) return &pair;
  return nullptr;
}

// A planet's mates are met again where its direction is greater by a pitch of both together.
std::string remedy(const CylindricalDrive& d, const CylindricalGeometry& g, const GearPair& closing,
                   double beyond) {
  const GearPair* of_planet = placing(d, closing.first);
  const Toothing& ring = g.gear[closing.second];
  if (!of_planet || !ring.internal || d.gears[of_planet->first].internal) return "change directions or teeth";
  const int z = d.gears[of_planet->first].z + ring.z;
  const double would_do = of_planet->direction + beyond * ring.z / z;
  const std::string& name = d.gears[closing.first].name;
  return name + "_direction: " + std::to_string(would_do * 180 / pi) + " deg would do; equal angles need " +
         std::to_string(z) + ", the teeth of sun and ring, to be a multiple of the number of planets";
}

void check_overlap(const CylindricalDrive& d, const CylindricalGeometry& g, int i, int k) {
  if (d.gears[i].internal || d.gears[k].internal) return;
  for (const GearPair& pair : d.pairs)
    if (std::minmax(pair.first, pair.second) == std::minmax(i, k)) return;
  const double room = (g.axis[i] - g.axis[k]).norm(), needed = g.gear[i].r_a + g.gear[k].r_a;
  require(room > needed, d.gears[i].name, " and ", d.gears[k].name,
          ": are not in mesh, and overlap: their axes ", "are ", mm(room), " mm apart, more than ",
          mm(needed), " mm is needed; take other directions or fewer gears");
}

}  // namespace

std::vector<double> angles(const CylindricalDrive& d, const CylindricalGeometry& g, double roll,
                           bool drive_side) {
  return stand(d, g, roll, drive_side).angle;
}

void check_loops(const CylindricalDrive& d, const CylindricalGeometry& g) {
  const int n = static_cast<int>(d.gears.size());
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < i; ++k) check_overlap(d, g, k, i);
  const Stand s = stand(d, g, 0, true);
  for (std::size_t i = 0; i < d.pairs.size(); ++i) {
    const GearPair& pair = d.pairs[i];
    const int expected = pair_sign(g.gear[pair.first], g.gear[pair.second]) > 0 ? -1 : 1;
    require(s.turns[pair.second] == expected * s.turns[pair.first], "pair ", pair_name(d, pair),
            ": closes a loop in which the gears cannot turn");
    const double beyond = beyond_touch(g, pair, g.pair[i], s),
                 off = std::abs(beyond) * g.gear[pair.second].r_b;
    require(off <= kMeeting * d.m_n, "pair ", pair_name(d, pair), ": its flanks miss each other by ", mm(off),
            " mm when the other gears touch; ", remedy(d, g, pair, beyond));
  }
}

}  // namespace elastogear::gear
