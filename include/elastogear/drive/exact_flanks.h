#pragma once
// Charts of the exact flanks of gears and worms, as contact at stations sees them (docs/theory,
// section 6.18).

#include <memory>
#include <optional>

#include "elastogear/contact/exact_flanks.h"
#include "elastogear/gear/modification.h"
#include "elastogear/gear/toothing.h"

namespace elastogear::drive {

/// What the layers of a mesh are along its faces.
enum class Layers { transverse, axial };

/// z is the place of a transverse section, or for axial ones, as of worms, where a cylinder about the axis
/// has it: an axial section has one z. v of involutes is their arc length, v of others goes with the radius.
std::shared_ptr<const contact::ExactFlanks> exact_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations, Layers layers);

}  // namespace elastogear::drive
