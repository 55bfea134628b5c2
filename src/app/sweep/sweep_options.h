#pragma once
// Options of a sweep, `analysis: sweep`: positions of a drive.

#include <vector>

#include "app/gear/drive.h"
#include "app/options/options.h"
#include "app/setup/system_setup.h"
#include "elastogear/dynamics/sweep.h"

namespace elastogear::app {

/// Rows for the options.
OptionTable sweep_table();

/// Roll angles in pitches, ascending. Throws Error naming value and remedy.
std::vector<double> sweep_positions(const Options& options, const Drive& drive);

/// The motion of a drive whose members stand at roll 0, by the roll angle in pitches. Changes the speed of
/// regularised friction to that of a motion of one pitch a second.
dynamics::SlowMotion slow_motion(const Options& options, const Drive& drive, const SystemSetup& setup);

}  // namespace elastogear::app
