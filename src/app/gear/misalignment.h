#pragma once
// Misalignment of the gears of a drive, as deviations of their axes from the places of the design.

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

OptionTable misalignment_table();

/// Moves and tilts the members as the options say. Throws Error naming value and remedy.
void misalign(const Options& options, Drive& drive);

}  // namespace elastogear::app
