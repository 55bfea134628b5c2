#pragma once
// Options of the bearings of gears.

#include <vector>

#include "app/gear/drive.h"
#include "app/options/options.h"
#include "elastogear/drive/drive_system.h"

namespace elastogear::app {

/// The rows of bearings.
OptionTable bearing_table();

/// A member's bearings; none: its axis is fixed. Throws Error for options that exclude or need each other,
/// and for what the catalogue does not have.
std::vector<drive::Bearing> bearings(const Options& options, const DriveMember& member);

}  // namespace elastogear::app
