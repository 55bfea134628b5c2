#pragma once
// The results of a sweep, joined from its units.

#include <string>
#include <vector>

#include "app/sweep/sweep_units.h"

namespace elastogear::app {

/// What was found in all units of a case, or of all cases.
struct SweepFound {
  int positions = 0;
  dynamics::SweepSummary summary;
  double work = 0, dissipated = 0, largest_imbalance = 0;  ///< J, of the last case
};

/// Writes the result file of a case, with roll angles as times. The energies of each unit go on from those of
/// the one before. Without any position found no file is written. Error when a unit is missing or damaged,
/// WriteFailure when the file cannot be written.
SweepFound write_case(const std::string& path, const model::ResultHeader& header, const UnitStore& store,
                      const std::vector<SweepUnit>& units);

/// Adds what a case has found.
void add(SweepFound& all, const SweepFound& one);

}  // namespace elastogear::app
