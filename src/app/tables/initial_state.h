#pragma once
// A run that begins where another one was at some time.

#include <vector>

#include "app/options/options.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::app {

/// Rows for the options.
OptionTable initial_state_table();

/// Joint coordinates and rates of the body of this name in the result file of -initial_file at -initial_time,
/// in place of those in `setup`; nothing when no file is given or it has no such body. Error when its joint
/// has another number of coordinates or tumbles.
void set_initial_state(const Options& options, dynamics::BodySetup& setup);

/// The deformation of the body of `setup` and what it remembers of its loads in the last state of that file;
/// nothing when it has none of it. Dynamic analyses only.
void set_relaxed_state(const Options& options, dynamics::BodySetup& setup);

/// Error when the file is given but no body takes its state, or its time is given without it.
void require_state_is_used(const Options& options, const std::vector<dynamics::BodySetup>& bodies);

}  // namespace elastogear::app
