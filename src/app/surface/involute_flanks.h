#pragma once
// Charts of involute flanks: arc length of the transverse involute, and place along the face or the thread.

#include <memory>
#include <optional>

#include "elastogear/contact/exact_flanks.h"
#include "elastogear/gear/modification.h"
#include "elastogear/gear/toothing.h"

namespace elastogear::app {

/// What the layers of a mesh are along its faces.
enum class Layers { transverse, axial };

/// z is the place of a transverse section, or for axial ones, as of worms, where the flank that goes on has
/// it on the base cylinder. Null for flanks that are no involutes.
std::shared_ptr<const contact::ExactFlanks> involute_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations, Layers layers);

}  // namespace elastogear::app
