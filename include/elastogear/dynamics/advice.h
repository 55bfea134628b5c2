#pragma once
// Advice for a run from its bodies and contacts: the time step that they require, and the limits of the
// theory (docs/theory, section 8.5).

#include <memory>

#include "elastogear/dynamics/deformation.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::dynamics {

/// A vibration that a run should resolve; frequency 0: there is none.
struct Vibration {
  std::string name;      ///< of the body or pair
  double frequency = 0;  ///< Hz
  /// s: ten steps a period, at which the trapezoidal rule is 3 % too slow; infinite without a vibration
  double step() const;
};

struct Advice {
  Vibration mode;       ///< highest mode of a modal basis
  Vibration contact;    ///< of a node on its penalty stiffness, by the inertia that it has in the basis
  double step() const;  ///< s, the smaller one
};
Advice advise(const System& system);

/// Watches whether elastic rotations and strains stay small, bodies turn slowly against their lowest mode
/// and against what their inertia level keeps, contact stays where bodies with residual flexibility have
/// static responses, and surfaces of a pair go by less than the contact depth in a step.
class ValidityGuard {
 public:
  /// dt: s, of a step; 0: there are no steps in time.
  explicit ValidityGuard(const System& system, double dt = 0);
  /// Returns one sentence for each limit that this state exceeds for the first time.
  std::vector<std::string> warnings(const model::Snapshot& snapshot);

 private:
  struct Watch {
    DeformationWatch deformation;
    double lowest_mode = 0;    // rad/s; 0: none
    double lost_coriolis = 0;  // s, over the speed: largest relative error of a frequency
    double radius = 0;         // m, of the surface around the body frame's origin
    bool deformed = false, fast = false, too_coarse = false, beside_loaded = false;  // said
  };
  using Warnings = std::vector<std::string>;
  double surface_speed(std::size_t b, const model::BodyState& state) const;
  void watch_body(std::size_t b, const model::Snapshot& snapshot, Warnings& said);
  void watch_pair(std::size_t p, const model::Snapshot& snapshot, Warnings& said);

  const System* system_;
  double dt_;
  std::vector<Watch> watch_;
  std::vector<bool> too_fast_;  // pairs, said
};

/// Watches whether contact chatters or vibrates beyond the modes (docs/theory, section 6.11), of pairs
/// without a penalty whose forces are solved for together with static responses.
class ChatterWatch {
 public:
  explicit ChatterWatch(const System& system);
  /// To be called with states one after the other. Returns one sentence for each pair whose force turns from
  /// state to state, or at a frequency that its modes do not resolve, for the first time.
  std::vector<std::string> warnings(const model::Snapshot& snapshot);

 private:
  struct Force {
    bool watched = false;
    double highest_mode = 0;      // Hz
    double begin = 0;             // s, of the present window
    double last = 0, change = 0;  // N, in the last state, and its change before
    int states = 0, turns = 0;    // of the present window, and how often the force turned in it
    double sum = 0, changes = 0;  // N, of the present window: of forces, and of their changes
  };
  static std::string unsteady(Force& force, double time, double now);

  const System* system_;
  std::vector<Force> force_;  // of each pair
};

}  // namespace elastogear::dynamics
