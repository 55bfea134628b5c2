#pragma once
// Tooth outlines of the worm drive, and the rack that generates its wheel.

#include "elastogear/gear/design.h"
#include "gear/rack.h"

namespace elastogear::gear {

/// Profile of the worm, axial section, of a design whose form radii are known (Geometry of derive()).
Profile worm_profile(const Design& design, const Geometry& geometry);

/// Radius where the worm's flank ends and its fillet begins; throws Error when the fillet does not exist.
double worm_form_radius(const Design& design, const Geometry& geometry);

/// Throws Error when the rack's tip is too round for the space.
RackTip wheel_rack(const Design& design, const Geometry& geometry);

}  // namespace elastogear::gear
