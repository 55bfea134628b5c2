#pragma once
// Bodies of a drive's gears.

#include "elastogear/drive/drive.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::drive {

/// How a gear is reduced: held where it is mounted, its flanks may be touched, stresses are those of its
/// roots. It has static responses to contact forces and no modes, as sweeps and equilibria take; motions need
/// some.
reduction::ReductionOptions reduction_options(const Member& member, const model::Material& material);

}  // namespace elastogear::drive
