#include "app/resumable_run.h"

#include <csignal>
#include <filesystem>

#include "app/console/console.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/fingerprint.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::app {
namespace {

enum class Resume { automatic, anyway, discard };

// Options on which results do not depend, as parts of their names.
const std::vector<std::string> kWithoutEffect = {
    "option_output", "option_checkpoint_every", "option_resume",      "option_monitor", "_monitor", "_view",
    "option_log_",   "option_sensor_csv",       "option_ts_max_steps"};

volatile std::sig_atomic_t stop_signal = 0;

void on_signal(int signal) { stop_signal = signal; }

// The first signal asks the run to stop, a second one ends the program.
void listen_for_stop() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESETHAND;
  for (int signal : {SIGTERM, SIGINT}) sigaction(signal, &action, nullptr);
}

// The file that the value of an option names, or nothing.
std::string file_in(const std::string& key, const std::string& value) {
  const auto table = value.find("table,");
  if (table != std::string::npos) return value.substr(table + 6);
  return key == "option_output_times" ? value : "";
}

bool has_effect(const std::string& key) {
  return std::none_of(kWithoutEffect.begin(), kWithoutEffect.end(),
                      [&](const std::string& part) { return key.find(part) != std::string::npos; });
}

// "ts_dt 2e-07 (was 1e-07)", one for each key that differs. A shared file has keys of other verbs as well.
std::string differences(const Options& options, const std::map<std::string, std::string>& now,
                        const std::map<std::string, std::string>& then) {
  std::string text;
  const auto value = [](const auto& map, const std::string& key) {
    const auto found = map.find(key);
    return found == map.end() ? std::string("not given") : found->second;
  };
  std::map<std::string, std::string> all = now;
  all.insert(then.begin(), then.end());
  for (const auto& [key, unused] : all) {
    const std::string a = value(now, key), b = value(then, key);
    const std::string name = key.starts_with("option_") ? key.substr(7) : key;
    if (a == b || !has_effect(key) || options.is_of_other_verb(name)) continue;
    text += (text.empty() ? "" : ", ") + name + " " + a + " (was " + b + ")";
  }
  return text;
}

std::optional<io::UnfinishedRun> earlier_run(const Options& options, const model::ResultHeader& header) {
  const auto resume = static_cast<Resume>(options.choice("resume", {"auto", "anyway", "discard"}));
  const std::string output = options.text("output");
  if (resume == Resume::discard) return {};
  std::optional<io::UnfinishedRun> earlier = io::read_unfinished_run(output);
  if (!earlier) return {};
  const std::string other = differences(options, header.provenance, earlier->provenance);
  require(other.empty() || resume == Resume::anyway, output,
          ".partial holds a run that did not end, until t = ", earlier->time, " s, with other input: ", other,
          ". -resume anyway continues it with the present one, -resume discard begins anew");
  if (!other.empty()) print_item("warning", "continues a run with other input: " + other);
  print_item("continued after", with_unit(earlier->time, "s"));
  return earlier;
}

// Times that have been written, s.
struct Written {
  double time = 0;                  // the last one
  std::optional<double> kept = {};  // the last one before a checkpoint, to go on from
};

// Throws Error that says why the run ended before its time, and how it can go on.
void require_complete(const dynamics::RunSummary& summary, const std::string& output, bool resumable) {
  const std::string cause = summary.out_of_steps
                                ? "stopped after " + std::to_string(summary.steps) + " steps (-ts_max_steps)"
                                : "stopped by signal " + std::to_string(int(stop_signal));
  require(summary.complete, cause, " at t = ", summary.time,
          " s, before the end. The result until then is in ", output,
          !resumable             ? "; the same command begins anew"
          : summary.out_of_steps ? "; with more of them the same command goes on from there"
                                 : "; the same command goes on from there");
}

// Computes and writes the whole run, or what there is when a step cannot be solved or a signal stops it.
dynamics::RunSummary write_run(io::ResultWriter& writer, const std::string& output,
                               const Computation& computation,
                               std::pair<const dynamics::Checkpoints&, Written&> state) {
  auto& [checkpoints, written] = state;
  dynamics::RunSummary summary;
  try {
    summary = computation(
        [&writer, &at = written.time](const model::Snapshot& snapshot) {
          writer.append(snapshot);
          at = snapshot.time;
        },
        checkpoints);
  } catch (const WriteFailure&) {
    throw;
  } catch (const Error& error) {
    if (writer.n_times() == 0) throw;
    writer.finish(false);
    const std::string why = error.what();
    fail(why, why.ends_with('?') ? "" : ".", " The result until t = ", written.time, " s is in ", output,
         written.kept ? "; with changed options, -resume anyway goes on from there" : "");
  }
  require(writer.n_times() > 0, "stopped by signal ", int(stop_signal),
          " before the first state was found: there is no result");
  writer.finish(summary.complete);
  require_complete(summary, output, written.kept.has_value());
  return summary;
}

}  // namespace

OptionTable resumable_run_table() {
  return {
      {"checkpoint_every", "s", "60", "wall-clock time between checkpoints; 0: after each step"},
      {"resume", "-", "auto",
       "an unfinished run beside the output: auto (go on if its input is the same), anyway (go on with the "
       "present options) or discard"}};
}

void add_inputs(const Options& options, const std::map<std::string, std::string>& identities,
                std::map<std::string, std::string>& provenance) {
  for (const auto& [body, identity] : identities)
    if (!identity.empty()) provenance[model::identity_key(body)] = identity;
  for (const auto& [key, value] : options.provenance()) {
    const std::string file = file_in(key, value);
    if (file.empty() || !std::filesystem::is_regular_file(file)) continue;
    Fingerprint f;
    f.add(read_file(file));
    provenance["fingerprint_" + file] = f.text();
  }
}

dynamics::RunSummary keep(const Options& options, const model::ResultHeader& header,
                          const Computation& computation) {
  const std::string output = options.text("output");
  std::optional<io::UnfinishedRun> earlier = earlier_run(options, header);
  dynamics::Checkpoints checkpoints;
  checkpoints.every = options.number("checkpoint_every");
  Written written;
  if (earlier) {
    written.kept = earlier->time;
    checkpoints.state = std::move(earlier->state);
  }
  try {
    io::ResultWriter writer(output, header, earlier.has_value());
    checkpoints.keep = [&](const std::vector<double>& state) {
      writer.checkpoint(state);
      written.kept = written.time;
    };
    checkpoints.stop = [] { return stop_signal != 0; };
    listen_for_stop();
    return write_run(writer, output, computation, {checkpoints, written});
  } catch (const WriteFailure& failure) {
    if (!written.kept) throw;
    fail(failure.what(), ". The run until t = ", *written.kept, " s is kept in ", output, ".partial");
  }
}

}  // namespace elastogear::app
