#pragma once
// The mesh of any gear: the transverse section of one tooth and its part of the body, extruded along the
// helix and repeated around.

#include <functional>
#include <string>

#include "elastogear/gear/blank.h"
#include "elastogear/gear/wheel.h"
#include "gear/tooth_grid.h"

namespace elastogear::gear {

/// Sets and numbering: see wheel_mesh. name: of the gear, for errors. The profile's r_inner is the rim's. The
/// node set at the outside of an internal gear is `outer`, in place of `bore`.
mesh::Mesh gear_mesh(const std::string& name, const Toothing& toothing, const Profile& profile,
                     const Blank& blank, const WheelCounts& counts);

/// The same of a gear whose section changes along the axis; profile: at z, m.
mesh::Mesh gear_mesh(const std::string& name, const Toothing& toothing,
                     const std::function<Profile(double z)>& profile, const Blank& blank,
                     const WheelCounts& counts);

}  // namespace elastogear::gear
