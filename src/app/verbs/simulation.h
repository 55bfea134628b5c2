#pragma once
// The system that `simulate` makes of its options, for programs that take the steps themselves.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/options/options.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::app {

/// Force laws that a program sets beside the options: along axes ("worm", "worm.rotation") and of loads.
struct ProgramLaws {
  std::map<std::string, dynamics::ForceLaw> of_axes;
  std::map<std::string, dynamics::WrenchLaw> of_loads;
};

struct PreparedSimulation {
  std::unique_ptr<dynamics::System> system;
  dynamics::TimeSettings time;
  model::ResultHeader header;
};

/// Makes the laws, given the names of the loads.
using MakeLaws = std::function<ProgramLaws(const std::vector<std::string>& loads)>;

/// The system and settings of analysis dynamic or relax, with the errors of `simulate`; nothing is written.
PreparedSimulation prepare_simulation(const Options& given, const MakeLaws& make_laws);

}  // namespace elastogear::app
