#pragma once
// Before a run: the step that it asks for. During it: where the theory ends.

#include "elastogear/dynamics/simulate.h"

namespace elastogear::app {

/// Prints the steps that the highest mode and the contact ask for, and warns when dt (s) is far from them.
void print_advice(const dynamics::System& system, double dt);

/// The same observer, which also prints warnings; the system must outlive it.
dynamics::Observer guarded(const dynamics::System& system, dynamics::Observer observer);

}  // namespace elastogear::app
