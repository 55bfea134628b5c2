#include "app/setup/resumable_run.h"

#include <algorithm>
#include <csignal>

#include "app/console/console.h"
#include "app/console/embedding.h"
#include "app/options/input_differences.h"
#include "app/options/rows.h"
#include "elastogear/base/file.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::app {
namespace {

// Options on which results do not depend, and parts of the names of others and of entries of the provenance.
const std::vector<std::string> kWithoutEffect = {"output",       "checkpoint_every", "resume", "sensor_csv",
                                                 "ts_max_steps", "drawing",          "mesh",   "verbose"},
                               kPartsWithoutEffect = {"monitor",   "_view",         "option_log_",
                                                      "in_files_", "command_line_", "_mesh_output"};

volatile std::sig_atomic_t stop_signal = 0;

void on_signal(int signal) { stop_signal = signal; }

// The first signal asks the run to stop, a second one ends the program. Batch systems send those for users
// and for the limit of time; what is ignored, as nohup does with SIGHUP, stays so.
void listen_for_stop() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESETHAND;
  for (int signal : {SIGTERM, SIGINT, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2}) {
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
}

// Asks the program that the verb runs in, or the signals.
std::function<std::string()> stop_cause() {
  if (const Embedding* in = embedding())
    return [in] { return in->interrupted() ? std::string("an interrupt") : std::string(); };
  listen_for_stop();
  return [] { return stop_signal == 0 ? "" : "signal " + std::to_string(int(stop_signal)); };
}

// The files that the value of an option names.
std::vector<std::string> files_in(const Options& options, const std::string& key, const std::string& value) {
  const auto table = value.find("table,");
  if (table != std::string::npos) return {value.substr(table + 6)};
  const bool names_files =
      key.starts_with("option_") &&
      (key == "option_output_times" || key == "option_variants" || key.ends_with("_flanks") ||
       key.ends_with("_deviation") || key.ends_with("_topography") || key.ends_with("_wear") ||
       key.ends_with("_master_curve") || key.ends_with("_mesh") || key == "option_bearing_catalogue");
  return names_files ? options.list(key.substr(7)) : std::vector<std::string>{};
}

// key: of the provenance, "option_output".
bool is_without_effect(const std::string& key) {
  const auto is_part = [&](const std::string& part) { return key.find(part) != std::string::npos; };
  return std::any_of(kPartsWithoutEffect.begin(), kPartsWithoutEffect.end(), is_part) ||
         std::any_of(kWithoutEffect.begin(), kWithoutEffect.end(),
                     [&](const std::string& name) { return key == "option_" + name; });
}

// The option that an entry of the provenance is, or its key; "" where results do not depend on it. A shared
// file has keys of other verbs as well.
std::string input_name(const Options& options, const std::string& key) {
  const std::string name = key.starts_with("option_") ? key.substr(7) : key;
  return is_without_effect(key) || options.is_of_other_verb(name) ? "" : name;
}

using dynamics::ResumableSettings;

const Rows<ResumableSettings> kRows = {
    {"checkpoint_every", &ResumableSettings::checkpoint_every, "s",
     "wall-clock time between checkpoints; 0: after each step"},
    {"resume", &ResumableSettings::resume, one_of("auto", "anyway", "discard", "replace"),
     "an unfinished run beside the output: auto (go on if its input is the same, else refuse), anyway (go on "
     "with the present options), discard, or replace (go on if its input is the same, else begin anew; "
     "default of run)"},
};

}  // namespace

bool affects_results(const std::string& name) { return !is_without_effect("option_" + name); }

OptionTable resumable_run_table() { return table_of(kRows); }

void add_inputs(const Options& options, const std::map<std::string, std::string>& identities,
                std::map<std::string, std::string>& provenance) {
  for (const auto& [body, identity] : identities)
    if (!identity.empty()) provenance[model::identity_key(body)] = identity;
  for (const auto& [key, value] : options.provenance())
    for (const std::string& file : files_in(options, key, value)) {
      if (!is_file(file)) continue;
      provenance[fingerprint_key(file)] = file_fingerprint(file);
    }
}

dynamics::ResumableSettings resumable_settings(const Options& options, const std::string& output) {
  ResumableSettings settings;
  settings.output = output;
  read_rows(options, kRows, settings);
  settings.input_name = [&options](const std::string& key) { return input_name(options, key); };
  settings.on_replace = [output](const std::string& differences) {
    print_item("begun anew", output + ".partial held a run of other input: " + differences);
  };
  settings.stop_cause = stop_cause();
  return settings;
}

dynamics::RunSummary keep(const Options& options, const model::ResultHeader& header,
                          const dynamics::Computation& computation) {
  ResumableSettings settings = resumable_settings(options, options.text("output"));
  settings.on_resume = [](double time, const std::string& differences) {
    if (!differences.empty()) print_item("warning", "continues a run with other input: " + differences);
    print_item("continued after", with_unit(time, "s"));
  };
  return dynamics::resumable_run(settings, header, computation);
}

}  // namespace elastogear::app
