#include "elastogear/dynamics/resumable_run.h"

#include "dynamics/run/run.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/io/result_file.h"

namespace elastogear::dynamics {
namespace {

constexpr const char* kRemedy = "; -resume discard begins anew";

// Null where there is none. What is there may be of another version of the program, or damaged.
std::optional<io::UnfinishedRun> left_behind(const std::string& output) {
  try {
    return io::read_unfinished_run(output);
  } catch (const Error& error) {
    fail(error.what(), kRemedy);
  }
}

std::optional<io::UnfinishedRun> earlier_run(const ResumableSettings& settings,
                                             const model::ResultHeader& header) {
  if (settings.resume == Resume::discard) return {};
  std::optional<io::UnfinishedRun> earlier = left_behind(settings.output);
  if (!earlier) return {};
  const std::string other = differences(settings, header.provenance, earlier->provenance);
  if (!other.empty() && settings.resume == Resume::replace) {
    if (settings.on_replace) settings.on_replace(other);
    return {};
  }
  require(other.empty() || settings.resume == Resume::anyway, settings.output,
          ".partial holds a run that did not end, until t = ", earlier->time, " s, with other input: ", other,
          ". -resume anyway continues it with the present one, -resume discard begins anew");
  if (settings.on_resume) settings.on_resume(earlier->time, other);
  return earlier;
}

// A run that is being computed and written.
struct Writing {
  const ResumableSettings& settings;
  io::ResultWriter& writer;
  std::optional<double>& kept;  // s, last time before a checkpoint, to go on from
  double time;                  // s, last that was written

  std::string stop_cause() const { return settings.stop_cause ? settings.stop_cause() : ""; }
};

// Throws Error that says why the run ended before its time, and how it can go on.
void require_complete(const RunSummary& summary, const Writing& run) {
  const std::string cause = summary.out_of_steps
                                ? "stopped after " + std::to_string(summary.steps) + " steps (-ts_max_steps)"
                                : "stopped by " + run.stop_cause();
  require(summary.complete, cause, " at t = ", summary.time,
          " s, before the end. The result until then is in ", run.settings.output,
          !run.kept              ? "; the same command begins anew"
          : summary.out_of_steps ? "; with more of them the same command goes on from there"
                                 : "; the same command goes on from there");
}

// Computes and writes the whole run, or what there is when a step cannot be solved or the run is stopped.
RunSummary write_run(Writing& run, const Computation& computation, const Checkpoints& checkpoints) {
  RunSummary summary;
  try {
    summary = computation(
        [&run](const model::Snapshot& snapshot) {
          run.writer.append(snapshot);
          run.time = snapshot.time;
        },
        checkpoints);
  } catch (const WriteFailure&) {
    throw;
  } catch (const UnfitState& error) {
    fail(run.settings.output, ".partial: ", error.what(), kRemedy);
  } catch (const std::exception& error) {  // memory that lacks, too
    if (run.writer.n_times() == 0) throw;
    run.writer.finish(false);
    const std::string why = failure_text(error);
    fail(why, why.ends_with('?') ? "" : ".", " The result until t = ", run.time, " s is in ",
         run.settings.output, run.kept ? "; with changed options, -resume anyway goes on from there" : "");
  }
  require(run.writer.n_times() > 0, "stopped by ", run.stop_cause(),
          " before the first state was found: there is no result");
  run.writer.finish(summary.complete);
  require_complete(summary, run);
  return summary;
}

}  // namespace

std::string differences(const ResumableSettings& settings, const Provenance& now, const Provenance& then) {
  std::string text;
  const auto value = [](const auto& map, const std::string& key) {
    const auto found = map.find(key);
    return found == map.end() ? std::string("not given") : found->second;
  };
  Provenance all = now;
  all.insert(then.begin(), then.end());
  for (const auto& [key, unused] : all) {
    const std::string a = value(now, key), b = value(then, key);
    const std::string name = settings.input_name ? settings.input_name(key) : key;
    if (a == b || name.empty()) continue;
    text.append(text.empty() ? "" : ", ").append(name).append(" ").append(a);
    text.append(" (was ").append(b).append(")");
  }
  return text;
}

void require_no_run(const ResumableSettings& settings) {
  if (settings.resume == Resume::discard) return;
  if (const auto run = left_behind(settings.output))
    fail(settings.output, ".partial holds a run that did not end, until t = ", run->time,
         " s. Another -output leaves it there, -resume discard removes it");
}

RunSummary resumable_run(const ResumableSettings& settings, const model::ResultHeader& header,
                         const Computation& computation) {
  std::optional<io::UnfinishedRun> earlier = earlier_run(settings, header);
  std::optional<double> kept;
  if (earlier) kept = earlier->time;
  try {
    io::ResultWriter writer(settings.output, header, earlier.has_value());
    Writing run{settings, writer, kept, kept.value_or(0)};
    Checkpoints checkpoints;
    checkpoints.every = settings.checkpoint_every;
    checkpoints.keep = [&](const std::vector<double>& state) {
      writer.checkpoint(state);
      kept = run.time;
    };
    checkpoints.stop = [&run] { return !run.stop_cause().empty(); };
    if (earlier) checkpoints.state = std::move(earlier->state);
    return write_run(run, computation, checkpoints);
  } catch (const WriteFailure& failure) {
    if (!kept) throw;
    fail(failure.what(), ". The run until t = ", *kept, " s is kept in ", settings.output, ".partial");
  }
}

}  // namespace elastogear::dynamics
