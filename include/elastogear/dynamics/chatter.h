#pragma once
// Watches whether contact chatters: docs/theory.md, section 6.11.

#include <string>
#include <vector>

#include "elastogear/dynamics/system.h"

namespace elastogear::dynamics {

/// Of pairs without a penalty whose forces are solved for together with static responses.
class ChatterWatch {
 public:
  explicit ChatterWatch(const System& system);
  /// To be called with states one after the other. Returns one sentence for each pair whose force goes to and
  /// fro from state to state for the first time.
  std::vector<std::string> warnings(const model::Snapshot& snapshot);

 private:
  struct Force {
    bool watched = false;
    double last = 0, change = 0;  // N, in the last state, and its change before
    int states = 0, turns = 0;    // of the present window, and how often the force turned in it
    double sum = 0, changes = 0;  // N, of the present window: of forces, and of their changes
  };
  static bool chatters(Force& force, double now);

  const System* system_;
  std::vector<Force> force_;  // of each pair
};

}  // namespace elastogear::dynamics
