#pragma once
// Options of a drive's micro-geometry: modifications of the flanks and deviations of manufacture.

#include <optional>

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

OptionTable modification_table();

/// Deviations of the member's flanks; nothing where none are given. Throws Error naming value and remedy.
std::optional<gear::FlankDeviations> flank_deviations(const Options& options, const DriveMember& member);

}  // namespace elastogear::app
