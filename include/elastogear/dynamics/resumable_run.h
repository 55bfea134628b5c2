#pragma once
// A run whose result survives: interrupted by force it goes on from its last checkpoint, stopped or ended by
// a step that cannot be solved it leaves what it has.

#include <functional>
#include <map>
#include <string>

#include "elastogear/dynamics/simulate.h"
#include "elastogear/model/result.h"

namespace elastogear::dynamics {

/// What becomes of an unfinished run beside the result. automatic: it goes on if its input is the same, else
/// an Error tells in what it differs; anyway: it goes on with the present one; discard: the run begins anew;
/// replace: it goes on if its input is the same, else the run begins anew.
enum class Resume { automatic, anyway, discard, replace };

struct ResumableSettings {
  std::string output;            ///< result file; parts of it are kept in the folder `output`.partial
  double checkpoint_every = 60;  ///< s of wall time between two; 0: after each step
  Resume resume = Resume::automatic;
  /// Returns the name of the input that this entry of the provenance is, for messages; "" where results do
  /// not depend on it. Empty: they depend on all entries, whose keys are their names.
  std::function<std::string(const std::string& key)> input_name = {};
  /// Is told the time (s) from which an earlier run goes on, and in what its input differs, such as
  /// "ts_dt 2e-07 (was 1e-07)".
  std::function<void(double time, const std::string& differences)> on_resume = {};
  /// Is told, in the same words, why an earlier run is replaced.
  std::function<void(const std::string& differences)> on_replace = {};
  /// Asked while it runs: why the run shall stop, such as "signal 15"; empty: it shall not.
  std::function<std::string()> stop_cause = {};
};

/// Observes all output times, from the start or from a checkpoint on: simulate() or solve_static().
using Computation = std::function<RunSummary(const Observer& observer, const Checkpoints& checkpoints)>;

using Provenance = std::map<std::string, std::string>;
/// "ts_dt 2e-07 (was 1e-07)", one for each key with an effect that differs; empty: two runs have equal input.
std::string differences(const ResumableSettings& settings, const Provenance& now, const Provenance& then);

/// Error, with the ways out, where a run beside the result did not end, unless it shall be discarded. For
/// what has that result, too, and cannot go on from a run.
void require_no_run(const ResumableSettings& settings);

/// Computes a run and writes its result. Error when an unfinished run with other input is there, or when the
/// run does not reach its end; what it has is in the file then. WriteFailure when the file cannot be written;
/// the last checkpoint stays.
RunSummary resumable_run(const ResumableSettings& settings, const model::ResultHeader& header,
                         const Computation& computation);

}  // namespace elastogear::dynamics
