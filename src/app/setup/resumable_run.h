#pragma once
// Options of runs whose result survives (dynamics/resumable_run.h), what makes two runs the same, and
// signals.

#include <map>
#include <string>

#include "app/options/options.h"
#include "elastogear/dynamics/resumable_run.h"

namespace elastogear::app {

/// Rows for the options.
OptionTable resumable_run_table();

/// Do results depend on this option?
bool affects_results(const std::string& name);

/// Adds the identities of bodies, by name, and fingerprints of the files of tables to the provenance.
void add_inputs(const Options& options, const std::map<std::string, std::string>& identities,
                std::map<std::string, std::string>& provenance);

/// What the options say of a run that writes `output`: how it goes on and what stops it. SIGTERM and SIGINT
/// stop the run from now on, a second one ends the program.
dynamics::ResumableSettings resumable_settings(const Options& options, const std::string& output);

/// Runs and writes -output by dynamics::resumable_run, and says where an earlier run goes on.
dynamics::RunSummary keep(const Options& options, const model::ResultHeader& header,
                          const dynamics::Computation& computation);

}  // namespace elastogear::app
