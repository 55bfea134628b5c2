#pragma once
// Internal teeth as a pinion-type cutter generates them whose pitch circle rolls inside the gear's: involute,
// and the trochoid of the cutter's rounded tip as fillet (docs/theory, section 9). Transverse section.

#include <Eigen/Core>

#include "elastogear/gear/toothing.h"
#include "gear/profile.h"

namespace elastogear::gear {

struct Cutter {
  Toothing teeth;  ///< z, r, r_b, r_a, alpha_t and psi_b
  double a = 0;    ///< m, centre distance
  double rho = 0;  ///< m, radius of the arc tangent to tip circle and flank
};

/// The cutter with z_0 teeth of a gear whose pitch and root radius and tooth thickness are known. rho: m, of
/// its tip; 0: what fits, at most that of the rack.
Cutter cutter(const Toothing& gear, int z_0, double rho);

/// m, the radius with which its tip is one arc; below 0 where it is pointed.
double largest_tip_radius(const Toothing& cutter);

/// (angle from the axis of the gear's tooth, radius) of the point that the tip's arc cuts where its normal is
/// turned by b from the radial direction of the arc's centre, 0 at the root land.
Eigen::Vector2d trochoid(const Cutter& cutter, const Toothing& gear, double b);

/// Of the trochoid's end, where the flank begins: b in rad, radius in m.
double last_normal(const Cutter& cutter);
double form_radius(const Cutter& cutter, const Toothing& gear);

/// m, the least tip radius that the cutter's involute reaches.
double least_tip_radius(const Cutter& cutter, const Toothing& gear);

/// Does the cutter, on its way in and out of the space, spare the flanks up to the tip?
bool spares_flanks(const Cutter& cutter, const Toothing& gear);

/// From the tip circle to r_inner, which lies outside of the root circle.
Profile shaped_profile(const Cutter& cutter, const Toothing& gear, double r_inner);

}  // namespace elastogear::gear
