#pragma once
// The options of life.

#include <map>
#include <string>
#include <vector>

#include "app/gear/drive.h"
#include "app/options/options.h"
#include "elastogear/life/duty_cycle.h"

namespace elastogear::app {

/// What the options ask for, whatever the gear.
struct LifeSettings {
  std::vector<std::string> files = {};  ///< results or stresses of sweeps
  std::vector<double> torques = {};     ///< N m, of these files; empty: as they say
  std::string variant = {};             ///< of the sweep's cases
  std::string output = {};
  bool proportional = false;  ///< stresses are scaled outside the torques of the sweep
  bool field = true;          ///< damage on the bodies' meshes, for ParaView
  std::map<std::string, std::vector<std::string>> sets = {};  ///< of nodes, by gear
  std::map<std::string, std::string> body_file = {};          ///< by gear, where results name another place
};

/// Strength of one gear.
struct Strength {
  life::SnCurve curve;  ///< for the wanted probability of survival
  life::MeanStress mean_stress;
};

/// Rows for the options of life, beside those of drives and of recover.
OptionTable life_table();

LifeSettings life_settings(const Options& options, const Drive& drive);

/// Strength of a gear: its own keys, and those of all gears where it has none. Error, naming the key and the
/// remedy, when something is missing or wrong.
Strength strength_of(const Options& options, const std::string& gear);

/// Warns of strengths that no material of a gear has.
void warn_of_strengths(const Options& options, const Drive& drive);

/// The duty cycle, a list of torques and revolutions or hours, or a CSV file. Error naming entry or line.
std::vector<life::Block> duty_cycle(const Options& options);

}  // namespace elastogear::app
