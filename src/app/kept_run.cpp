#include "app/kept_run.h"

#include <csignal>
#include <filesystem>

#include "app/console.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/fingerprint.h"

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

void add(Fingerprint& f, const Eigen::SparseMatrix<double>& A) {
  f.add_all(std::vector<double>{double(A.rows()), double(A.cols())});
  for (int j = 0; j < A.outerSize(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator it(A, j); it; ++it)
      f.add_all(std::vector<double>{double(it.row()), double(it.col()), it.value()});
}

void add(Fingerprint& f, const model::BasisRows& rows) {
  if (const auto* dense = std::get_if<model::DenseRows>(&rows))
    return f.add_block(dense->data(), static_cast<std::size_t>(dense->size()));
  add(f, Eigen::SparseMatrix<double>(std::get<model::SparseRows>(rows)));
}

// Of all that dynamics reads of a body.
std::string fingerprint(const model::ElasticBody& body) {
  Fingerprint f;
  const model::Inertia& inertia = body.inertia;
  f.add_all(std::vector<double>{inertia.m, body.alpha, body.beta});
  for (const Eigen::MatrixXd& M :
       {Eigen::MatrixXd(inertia.c), Eigen::MatrixXd(inertia.J), Eigen::MatrixXd(inertia.C_l),
        Eigen::MatrixXd(inertia.C_r), Eigen::MatrixXd(inertia.S_1), Eigen::MatrixXd(body.surface.X),
        Eigen::MatrixXd(body.surface.c_f)})
    f.add_all(M.reshaped());
  for (const model::BasisRows& rows : inertia.S_2) add(f, rows);
  add(f, body.M_r);
  add(f, body.K_r);
  f.add_all(body.surface.node);
  f.add_all(body.surface.face.reshaped());
  f.add_all(body.surface.group);
  add(f, body.surface.Phi);
  f.add_all(body.zeta);
  f.add_all(body.flexibility.node);
  f.add_all(body.flexibility.self);
  for (const model::Marker& marker : body.markers) {
    f.add_all(marker.X);
    add(f, marker.Phi);
  }
  return f.text();
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

}  // namespace

OptionTable kept_run_table() {
  return {
      {"checkpoint_every", "s", "60", "wall-clock time between checkpoints; 0: after each step"},
      {"resume", "-", "auto",
       "an unfinished run beside the output: auto (go on if its input is the same), anyway (go on with the "
       "present options) or discard"}};
}

void add_inputs(const Options& options, const std::vector<dynamics::BodySetup>& bodies,
                std::map<std::string, std::string>& provenance) {
  for (const dynamics::BodySetup& setup : bodies)
    provenance["fingerprint_" + setup.name] = fingerprint(*setup.body);
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
  if (earlier) checkpoints.state = std::move(earlier->state);
  io::ResultWriter writer(output, header, earlier.has_value());
  bool resumable = earlier.has_value();
  checkpoints.keep = [&](const std::vector<double>& state) {
    writer.checkpoint(state);
    resumable = true;
  };
  checkpoints.stop = [] { return stop_signal != 0; };
  listen_for_stop();
  dynamics::RunSummary summary;
  double time = 0;
  try {
    summary = computation(
        [&](const model::Snapshot& snapshot) {
          writer.append(snapshot);
          time = snapshot.time;
        },
        checkpoints);
  } catch (const Error& error) {
    if (writer.n_times() == 0) throw;
    writer.finish(false);
    fail(error.what(), ". The result until t = ", time, " s is in ", output,
         resumable ? "; with changed options, -resume anyway goes on from there" : "");
  }
  require(writer.n_times() > 0, "stopped by signal ", int(stop_signal),
          " before the first state was found: there is no result");
  writer.finish(summary.complete);
  const std::string cause = summary.out_of_steps
                                ? "stopped after " + std::to_string(summary.steps) + " steps (-ts_max_steps)"
                                : "stopped by signal " + std::to_string(int(stop_signal));
  require(summary.complete, cause, " at t = ", summary.time,
          " s, before the end. The result until then is in ", output,
          !resumable             ? "; the same command begins anew"
          : summary.out_of_steps ? "; with more of them the same command goes on from there"
                                 : "; the same command goes on from there");
  return summary;
}

}  // namespace elastogear::app
