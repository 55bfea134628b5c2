#pragma once
// The steps of derive(), each with the checks that belong to it.

#include <string>

#include "elastogear/gear/cylindrical.h"

namespace elastogear::gear {

inline double mm(double length) { return length / 1e-3; }

/// The value nearest to `high` for which `holds`, which is true at low, on either side of it.
template <class Holds>
double largest(double low, double high, Holds holds) {
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    if (middle == low || middle == high) break;
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

/// "pinion:wheel".
std::string pair_name(const CylindricalDrive& d, const GearPair& pair);

/// Numbers that have no meaning, whatever the others are.
void check_design(const CylindricalDrive& d);

/// The body of a gear, where nothing is given in proportion to its root.
Blank completed(const CylindricalDrive& d, const CylindricalGear& gear, const Toothing& t);

/// Half the thickness of a tooth as an angle at its base circle, rad. s_n: m, normal, at the pitch circle.
double half_angle_at_base(const CylindricalDrive& d, const Toothing& t, double s_n);

/// Axes and pairs, with the backlash that teeth without thinning have.
void place_gears(const CylindricalDrive& d, CylindricalGeometry& g);
/// Thinner teeth, for the backlash that is asked for.
void thin_teeth(const CylindricalDrive& d, CylindricalGeometry& g);
/// Tips that are not given, cutters of internal gears and form radii.
void shape_teeth(const CylindricalDrive& d, CylindricalGeometry& g);
/// Clearances and tips that cut.
void check_tips(const CylindricalDrive& d, CylindricalGeometry& g);
/// The ends of a pair's path of contact and contact ratios.
void set_path_of_contact(const CylindricalDrive& d, const GearPair& pair, CylindricalGeometry& g,
                         PairGeometry& p);
/// Pairs that close a loop touch where the others do; gears out of mesh do not overlap.
void check_loops(const CylindricalDrive& d, const CylindricalGeometry& g);

}  // namespace elastogear::gear
