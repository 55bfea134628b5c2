#pragma once
// Advice on the time step before a run, and warnings during the run where the theory ends.

#include <functional>

#include "elastogear/dynamics/simulate.h"

namespace elastogear::app {

/// Prints the steps that the highest mode and the contact ask for, and warns when dt (s) is far from them.
void print_advice(const dynamics::System& system, double dt);

/// An observer that prints warnings of dynamics::ValidityGuard and then calls `observer`; the system must
/// outlive it. dt: s, of a step; 0: there are no steps in time.
dynamics::Observer guarded(const dynamics::System& system, dynamics::Observer observer, double dt = 0);

/// A monitor that calls `monitor` and says once where steps that the run chooses (settings.dt = 0) stay so
/// short that many thousands are left to the end.
std::function<void(const dynamics::StepInfo&)> paced(const dynamics::TimeSettings& settings,
                                                     std::function<void(const dynamics::StepInfo&)> monitor);

}  // namespace elastogear::app
