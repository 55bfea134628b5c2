#pragma once
// Builds the bodies, joints, bushings, loads and sensors of a system from the options of simulate.

#include <vector>

#include "app/options/options.h"
#include "app/tables/body_options.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::app {

/// Rows for what surrounds the bodies.
OptionTable environment_table();

struct SystemSetup {
  std::vector<dynamics::BodySetup> bodies;
  std::vector<dynamics::PairSetup> pairs;
  dynamics::Environment environment;
  dynamics::MarkerSetups markers;
};

/// The system that the options describe; bodies that are not known yet are read. With a drive it is that of
/// the drive where no option says otherwise; null: there is none.
SystemSetup system_setup(const Options& options, const Drive* drive, KnownBodies& known);

/// What its result file says of the run that the options ask for.
model::RunInput run_input(const Options& options, const Drive* drive);

/// The header of its result file, with files of the bodies, provenance and input of the run.
model::ResultHeader result_header(const Options& options, const Drive* drive,
                                  const dynamics::SystemModel& system, const KnownBodies& known);

/// Prints the moduli of viscoelastic bodies and the law of each pair, and warns of options without effect on
/// it.
void print_laws(const Options& options, const dynamics::SystemModel& system);

}  // namespace elastogear::app
