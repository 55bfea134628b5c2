#pragma once
// The run of a sweep.

#include "app/options/options.h"

namespace elastogear::app {

/// Runs the sweep that a drive file describes, and writes its results.
void run_sweep(const Options& options);

}  // namespace elastogear::app
