#pragma once
// Static equilibrium F(lambda, U, 0, 0) = 0 by Newton's method with load stepping (docs/theory,
// section 8.6).

#include "elastogear/dynamics/simulate.h"

namespace elastogear::dynamics {

struct StaticSettings {
  int steps = 10;  ///< in which the load factor grows from 0 to 1; cut where Newton's method fails
  /// s, for which materials relax under the whole load, put on at time 0; 0: not at all. What is observed
  /// then has the time since in place of the load factor, and begins with the whole load.
  double time_under_load = 0;
};

/// Loads, prescribed motions and gravity as functions of the load factor in place of the time: loads from
/// zero, motions from time 0, to those at `time` (s; infinite: the last values). Error when a motion has no
/// value there, or the body an initial velocity.
void scale_by_load_factor(BodySetup& setup, double time);
void scale_by_load_factor(MarkerSetups& markers, double time);
void scale_by_load_factor(Environment& environment);

/// The equilibria at load factors 0 .. 1, of a system whose bodies and environment are scaled; observed with
/// the factor as time. Velocities and accelerations are zero, damping and friction without effect; work and
/// balance follow the load steps, and their error falls with the square of a step. Error, after the last
/// equilibrium was observed, when none is found: it names the coordinates that nothing holds. `stop` is asked
/// at each evaluation; true ends the analysis with the last equilibrium, not complete.
RunSummary solve_static(System& system, const StaticSettings& settings, const Observer& observer,
                        const Progress& progress = {}, const std::function<bool()>& stop = {});

}  // namespace elastogear::dynamics
