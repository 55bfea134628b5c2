#pragma once
// Equilibria of a system in slow motion, one position after the other (docs/theory, section 8.6).

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/dynamics/simulate.h"

namespace elastogear::dynamics {

/// A system at position 0, and how it moves as the position p grows. Loads keep their last value. A body
/// whose motion along its axis is prescribed stands where it is at time 0, turned on with p.
struct SlowMotion {
  std::vector<BodySetup> bodies;
  std::vector<PairSetup> pairs;
  Environment environment = {};
  MarkerSetups markers = {};
  /// rad per unit of p, of each body about the axis of its joint, of free ones about z of their frames: where
  /// p leads it when it is prescribed, where its search begins when it is not, and how fast surfaces slide,
  /// in a motion of one unit of p a second.
  std::vector<double> rate = {};
  /// rad per unit of p, of each bushing: turns what its second end is unloaded at about z of its axes.
  std::vector<double> bushing_rate = {};
  /// A system of the same bodies and pairs that is never evaluated: the systems of a sweep take from it what
  /// it has prepared for contact. Null: each sweep makes one of its own.
  std::shared_ptr<const System> prepared = nullptr;
};

/// Makes that system.
std::shared_ptr<const System> prepare(const SlowMotion& motion);

struct SweepSettings {
  std::vector<double> positions = {};  ///< p, ascending
  /// A position before these from which equilibria and energies count, which is not observed.
  std::optional<double> lead_in = {};
  int steps = 1;        ///< in which the loads grow at the first position; cut where Newton's method fails
  int more_steps = 10;  ///< where that fails, from the beginning
};

/// A position at which no equilibrium was found.
struct MissingPosition {
  double position;
  std::string why;
};

struct SweepSummary {
  RunSummary run;
  int restarts = 0;  ///< positions found from the unloaded state, as the one before did not lead there
  std::vector<MissingPosition> missing = {};
};

/// Throws Error for what cannot be swept: positions that do not ascend, friction that sticks, bodies with a
/// rate whose joint has no axis, what System refuses.
void validate(const SlowMotion& motion, const SweepSettings& settings);

/// Each equilibrium is found from the one before, by turning all bodies with their rate; the first one, and
/// those not found so, from the unloaded state at their position or shortly before it. They are observed with
/// p as time. Friction acts against the sliding of the rates. Work and losses count from the first one on,
/// which are those of the motion at one unit of p a second; losses by the trapezoidal rule. Bodies' memory of
/// earlier positions is none: the result does not depend on them but by the tolerance of the equilibria.
/// `stop` is asked at each evaluation; true ends the sweep, not complete.
SweepSummary sweep(const SlowMotion& motion, const SweepSettings& settings, const Observer& observer,
                   const Progress& progress = {}, const std::function<bool()>& stop = {});

}  // namespace elastogear::dynamics
