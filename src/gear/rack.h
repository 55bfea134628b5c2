#pragma once
// Teeth as the basic rack generates them: involute, and the trochoid of the rack's tip as fillet.

#include <Eigen/Core>

#include "elastogear/gear/toothing.h"
#include "gear/profile.h"

namespace elastogear::gear {

/// The rounded tip of the rack in its normal section: u along the pitch line from the middle of the gear's
/// tooth, h outwards from the pitch circle. Its arc goes from the land, where the normal has the angle pi/2,
/// to a straight flank, where it has the angle `end`. Without protuberance that is the flank which makes the
/// involute; a protuberance has a straight flank of its own in between.
struct RackTip {
  double alpha_n = 0;      ///< rad, of the flank that makes the involute
  double cos_beta = 1;     ///< -, of the helix angle at the pitch cylinder
  double r = 0;            ///< m, the gear's pitch radius
  Eigen::Vector2d centre;  ///< m, of the arc
  double rho = 0;          ///< m, radius of the arc
  double end = 0;          ///< rad, the normal's angle at the end of the arc
  double straight = 0;     ///< m, length of the protuberance's straight flank

  double length() const;  ///< m, of both
  bool has_protuberance() const { return end < alpha_n; }
};

/// What a tool has that stands out beyond the flanks which it makes, for teeth that are finished afterwards.
struct Protuberance {
  double amount = 0;  ///< m, of the tip's arc, along the flank's normal
  double alpha = 0;   ///< rad, pressure angle of the tool between the arc and the flank, below alpha_n
};

/// s_n: normal thickness of the gear's teeth at the pitch circle; depth: from there to the root circle; m.
RackTip rack_tip(double alpha_n, double beta, double r, double s_n, double depth, double rho,
                 const Protuberance& protuberance = {});

/// (angle from the tooth's axis, radius) of the point that the tip cuts at the fraction t in [0, 1] of its
/// way from the land to the flank (docs/theory, section 9).
Eigen::Vector2d trochoid(const RackTip& rack, double t);

/// m, from the pitch line to where the arc's tangent is parallel to the rack's straight flank, which ends
/// there without a protuberance, and how deep that may be without undercut.
double straight_depth(const RackTip& rack);
double undercut_depth(const Toothing& toothing);

/// Where the flank begins: at the trochoid's end, or, of teeth that undercut or a protuberance cut, where the
/// trochoid crosses the involute.
struct Form {
  double t = 1;       ///< of the way of trochoid()
  double r_form = 0;  ///< m; 0: a protuberance leaves no flank
  bool undercut = false;
};
Form form(const RackTip& rack, const Toothing& toothing);

/// From the tip circle to r_inner.
Profile generated_profile(const RackTip& rack, const Toothing& toothing, double r_inner);

}  // namespace elastogear::gear
