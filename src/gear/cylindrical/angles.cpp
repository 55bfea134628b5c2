#include <cmath>
#include <numbers>

#include "elastogear/gear/cylindrical.h"

namespace elastogear::gear {

// In pitches from the line between the axes, the angles of two mates add up to half a pitch: a tooth of one
// stands in the middle of a space of the other.
std::vector<double> angles(const CylindricalDrive& d, const CylindricalGeometry& g, double roll,
                           bool drive_side) {
  using std::numbers::pi;
  std::vector<double> angle(d.gears.size(), 0);
  std::vector<int> turns(d.gears.size(), drive_side ? 1 : -1);  // > 0: counter-clockwise
  if (!d.pairs.empty()) angle[0] = d.pairs[0].direction - pi / 2 + 2 * pi * roll / d.gears[0].z;
  for (std::size_t i = 0; i < d.pairs.size(); ++i) {
    const GearPair& pair = d.pairs[i];
    const Toothing &t_1 = g.gear[pair.first], &t_2 = g.gear[pair.second];
    const double turned = (angle[pair.first] + pi / 2 - pair.direction) * t_1.z / (2 * pi);
    const double closing = g.pair[i].j_n / (2 * t_2.r_b * std::cos(t_2.beta_b));
    angle[pair.second] =
        (0.5 - turned) * 2 * pi / t_2.z + pair.direction + pi / 2 + turns[pair.first] * closing;
    turns[pair.second] = -turns[pair.first];
  }
  return angle;
}

}  // namespace elastogear::gear
