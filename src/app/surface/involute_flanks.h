#pragma once
// Charts of the flanks of cylindrical gears: arc length of the involute and face coordinate.

#include <memory>
#include <optional>

#include "elastogear/contact/exact_flanks.h"
#include "elastogear/gear/modification.h"
#include "elastogear/gear/toothing.h"

namespace elastogear::app {

/// Null for flanks that are no involutes.
std::shared_ptr<const contact::ExactFlanks> involute_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations);

}  // namespace elastogear::app
