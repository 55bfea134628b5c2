#pragma once
// Damage of one node set of a gear, from its stresses at the torques of the sweeps.

#include <vector>

#include "app/life/life_report.h"

namespace elastogear::app {

/// One node set at all torques of the sweeps.
struct SetHistory {
  const DriveMember* member = nullptr;
  SweptStress place;  ///< nodes and positions; the stress of one of the torques
  life::Sweep sweep = {};
  std::vector<life::Revolutions> at = {};          ///< by torque
  std::vector<life::Revolutions> with_error = {};  ///< the same, larger by the estimated error; or fewer
  std::string body_file = {};                      ///< of the gear
};

/// proportional: see life::between. Error when the stress reaches what the material bears at once.
LifeOfSet life_of_set(const SetHistory& history, const Strength& strength, const std::vector<double>& torques,
                      const std::vector<life::Block>& blocks, bool proportional);

}  // namespace elastogear::app
