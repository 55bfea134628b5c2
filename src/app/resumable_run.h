#pragma once
// A run whose result survives: interrupted by force it goes on from its last checkpoint, stopped by a signal
// or by a step that cannot be solved it leaves what it has.

#include "app/options/options.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {

/// Rows for the options.
OptionTable resumable_run_table();

/// Adds the identities of bodies, by name, and fingerprints of the files of tables to the provenance.
void add_inputs(const Options& options, const std::map<std::string, std::string>& identities,
                std::map<std::string, std::string>& provenance);

/// Observes all output times, from the start or from a checkpoint on.
using Computation = std::function<dynamics::RunSummary(const dynamics::Observer& observer,
                                                       const dynamics::Checkpoints& checkpoints)>;

/// Runs and writes -output. Error when an unfinished run with other input is there, or when the run does not
/// reach its end; what it has is in the file then.
dynamics::RunSummary keep(const Options& options, const model::ResultHeader& header,
                          const Computation& computation);

}  // namespace elastogear::app
