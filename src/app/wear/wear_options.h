#pragma once
// The options of wear.

#include <cmath>
#include <string>

#include "app/gear/drive.h"
#include "app/options/options.h"

namespace elastogear::app {

struct WearSettings {
  double revolutions = 0;      ///< of the first gear
  double limit = 0;            ///< m, largest depth; 0: none
  double increment = 1e-6;     ///< m, largest growth of the depth between two sweeps
  int along = 40, across = 8;  ///< cells of a flank along its profile and across the face
  int most_sweeps = 1000;
};

/// Of one gear.
struct WearMaterial {
  double coefficient = 0;  ///< m^2/N, of Archard's law; 0: does not wear
  double density = 7850;   ///< kg/m^3
};

/// Rows for the options of wear, beside those of simulate.
OptionTable wear_table();

WearSettings wear_settings(const Options& options);

/// m, of the gear's teeth.
inline double tooth_height(const DriveMember& member) {
  return std::abs(member.toothing.r_a - member.toothing.r_f);
}

/// Throws Error for a limit of the depth that is beyond the height of the drive's teeth.
void require_limit_within_teeth(const Options& options, const WearSettings& settings, const Drive& drive);

/// The gear's own keys, and those of all gears where it has none. Warns of a density that no material has.
WearMaterial wear_material(const Options& options, const DriveMember& member);

}  // namespace elastogear::app
