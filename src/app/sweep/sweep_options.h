#pragma once
// Options of a sweep, `analysis: sweep`: positions of a drive.

#include <vector>

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

/// Rows for the options.
OptionTable sweep_table();

/// Roll angles in pitches, ascending. Throws Error naming value and remedy.
std::vector<double> sweep_positions(const Options& options, const Drive& drive);

}  // namespace elastogear::app
