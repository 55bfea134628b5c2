#pragma once
// The state in which the motion of a drive begins.

#include <memory>

#include "app/setup/system_setup.h"

namespace elastogear::app {

/// Puts the system that `given` describes, whose motion is asked for, at rest under its loads of time 0, with
/// the last gear held, and lets `model`, its motion, begin with joint coordinates and deformations of that
/// equilibrium (docs/theory, section 8.9). Returns the system at rest; null, and does nothing, where the
/// options say how a motion begins (initial_file, a gear's rotation_motion), nothing presses flanks together,
/// or no equilibrium is found.
std::unique_ptr<dynamics::System> begin_loaded(const Options& given, KnownBodies& known,
                                               dynamics::SystemModel& model);

/// Load steps in place of time steps: loads grow to those at `time` (s).
void make_static(SystemSetup& system, double time);

}  // namespace elastogear::app
