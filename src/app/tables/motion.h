#pragma once
// Loads and prescribed motions along a joint's axis from the words and numbers of the options; and damping
// ratios.

#include "app/options/options.h"
#include "elastogear/dynamics/axis.h"
#include "elastogear/model/damping.h"

namespace elastogear::app {

/// "5", "ramp,5,0.01" (value, duration) or "table,FILE.csv" (time, value).
dynamics::Signal signal(const Options& options, const std::string& name);

/// "0.02" or "table,FILE.csv" (frequency in Hz, ratio).
model::DampingRatio damping_ratio(const Options& options, const std::string& name);

/// "speed,14", "spin_up,14,0.01" (speed, duration) or "table,FILE.csv" (time, coordinate), from s_0 on.
dynamics::Drive drive(const Options& options, const std::string& name, double s_0);

}  // namespace elastogear::app
