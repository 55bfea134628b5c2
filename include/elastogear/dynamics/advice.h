#pragma once
// What a run should respect, from its bodies and contacts: the time step they ask for, and the limits of the
// theory.

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

/// Watches whether elastic rotations and strains stay small and bodies turn slowly against their lowest mode.
class ValidityGuard {
 public:
  explicit ValidityGuard(const System& system);
  /// What is left behind for the first time, one sentence each.
  std::vector<std::string> warnings(const model::Snapshot& snapshot);

 private:
  struct Edge {
    int node[2];
    double length;  // m
  };
  struct Watch {
    std::vector<Edge> edge;               // of some faces all over the surface
    double lowest_mode = 0;               // rad/s; 0: none
    bool deformed = false, fast = false;  // said
  };
  double gradient(std::size_t b, const Eigen::VectorXd& q) const;

  const System* system_;
  std::vector<Watch> watch_;
};

}  // namespace elastogear::dynamics
