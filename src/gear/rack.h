#pragma once
// Teeth as the basic rack generates them: involute, and the trochoid of the rack's tip as fillet.

#include <Eigen/Core>

#include "elastogear/gear/toothing.h"
#include "gear/profile.h"

namespace elastogear::gear {

/// The rounded tip of the rack in its normal section: u along the pitch line from the middle of the gear's
/// tooth, h outwards from the pitch circle. Its arc is tangent to the straight flank where the normal's angle
/// is alpha_n.
struct RackTip {
  double alpha_n = 0;      ///< rad
  double cos_beta = 1;     ///< -, of the helix angle at the pitch cylinder
  double r = 0;            ///< m, the gear's pitch radius
  Eigen::Vector2d centre;  ///< m, of the arc
  double rho = 0;          ///< m, radius of the arc
};

/// s_n: normal thickness of the gear's teeth at the pitch circle; depth: from there to the root circle; m.
RackTip rack_tip(double alpha_n, double beta, double r, double s_n, double depth, double rho);

/// (angle from the tooth's axis, radius) of the point that the tip's arc cuts where its normal has the angle
/// b in [alpha_n, pi/2] (docs/theory.md, section 9).
Eigen::Vector2d trochoid(const RackTip& rack, double b);

/// m, from the pitch line to the end of the rack's straight flank, and how deep it may be without undercut.
double straight_depth(const RackTip& rack);
double undercut_depth(const Toothing& toothing);

/// Where the flank begins: at the trochoid's end, or, of undercut teeth, where the trochoid crosses the
/// involute.
struct Form {
  double b = 0;       ///< rad, the normal's angle there, alpha_n without undercut
  double r_form = 0;  ///< m
  bool undercut = false;
};
Form form(const RackTip& rack, const Toothing& toothing);

/// From the tip circle to r_inner.
Profile generated_profile(const RackTip& rack, const Toothing& toothing, double r_inner);

}  // namespace elastogear::gear
