#pragma once
// The way of a tip's corner through the mate's space, which finds out whether tips cut into roots or, of
// internal pairs, into each other.

#include <vector>

#include "elastogear/gear/toothing.h"
#include "gear/profile.h"

namespace elastogear::gear {

/// Two gears in the transverse plane, flanks in contact.
struct TipPath {
  std::vector<Eigen::Vector2d>
      fillet;          ///< of `own`: radius, which increases (internal: -radius), angle from the tooth's axis
  Toothing own, mate;  ///< the mate's tip moves in a space of `own`
  double a = 0;        ///< m, centre distance
  double alpha_wt = 0;  ///< rad, working pressure angle
  double j = 0;         ///< m, backlash along the transverse line of action
};

/// profile: of `own`.
TipPath tip_path(const Profile& profile, const Toothing& own, const Toothing& mate, double a, double alpha_wt,
                 double j);

/// +1 of external pairs, -1 of internal ones, whose centre distance ISO 21771 counts below 0.
inline double pair_sign(const Toothing& t_1, const Toothing& t_2) { return t_1.sign() * t_2.sign(); }

/// m, distance along the line of action from where it touches the base circle to where it has the radius r.
double along_action(const Toothing& toothing, double r);

/// m, the same distance for `own` where it is xi for its mate, Eq. (9.3); action: between both base circles,
/// a sin(alpha_wt).
double along_own(const Toothing& own, const Toothing& mate, double action, double xi);

/// Whether the corner at the mate's tip radius r_a stays as far from fillet and flank as `least` (m, around
/// the axis); on an involute flank the distance is 0, < 0 where it cuts.
bool tip_keeps_off(const TipPath& path, double r_a, double least);

}  // namespace elastogear::gear
