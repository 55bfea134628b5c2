#pragma once
// The wheel that a hob makes: its geometry, and its section in any plane.

#include "gear/profile.h"
#include "gear/worm/hob.h"

namespace elastogear::gear {

/// Contact ratio, flanks and radii of a hobbed wheel and where contact begins on both bodies. Throws Error
/// where the hob undercuts the teeth or leaves them pointed, naming the face width that would do.
void derive_hobbed(const Design& design, Geometry& geometry);

/// Section of a right-handed hobbed wheel in the plane z, made symmetric by its shift.
Profile hobbed_profile(const Hob& hob, int z_2, double r_inner, double z);

}  // namespace elastogear::gear
