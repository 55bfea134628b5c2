#pragma once
// Charts of the exact flanks of gears and worms, as contact at stations sees them (docs/theory,
// section 6.18).

#include <memory>
#include <optional>

#include "elastogear/contact/exact_flanks.h"
#include "elastogear/gear/modification.h"
#include "elastogear/gear/toothing.h"

namespace elastogear::drive {

/// Which sections of a gear the layers of its mesh are.
enum class Layers {
  transverse,  ///< across the axis, as of cylindrical gears and wheels
  axial        ///< cylinders about the axis have their places on the flank, as of worms
};

/// Charts of all flanks of a gear, in its own frame, whose z is its axis. A chart's z (m) is the place of a
/// transverse section, or of axial layers where a cylinder about the axis has it: an axial section has one z.
/// Its v (m) is the arc length of involutes, and of other flanks goes with the radius. deviations: of the
/// flanks along their normals; nothing: they are those of the design. Never null.
std::shared_ptr<const contact::ExactFlanks> exact_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations, Layers layers);

}  // namespace elastogear::drive
