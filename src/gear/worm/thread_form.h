#pragma once
// Flank forms of worm threads (ISO 10828) by the tools that make them.

#include "elastogear/gear/design.h"

namespace elastogear::gear {

/// A right-handed toothing without flank form: radii, lead and the involute of its pressure angle. angle:
/// rad, lead angle of a thread, the complement of a wheel's helix angle; s_n: m, normal thickness at the
/// pitch cylinder.
Toothing pitch_toothing(const Design& design, int z, double angle, double s_n);

/// Sets the flanks of a right-handed thread, whose radii and lead are known, to the form of the design; s_x:
/// m, axial thickness at the pitch cylinder. Throws Error when the tool does not make flanks down to the
/// root.
void set_flank_form(const Design& design, double s_x, Toothing& thread);

/// Makes teeth thicker by moving their flanks along the axis; s_x: m, axially.
void thicken(Toothing& thread, double s_x);

/// Diameter of the cutter of form ZK, m.
double cutter_diameter(const Design& design);

}  // namespace elastogear::gear
