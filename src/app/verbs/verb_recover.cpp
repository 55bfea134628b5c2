// elastogear recover: result file -> stress histories, fields, pictures of the trees.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/options/verbs.h"
#include "app/setup/drive_input.h"
#include "app/tables/recover_options.h"
#include "app/verbs/recover_boxes.h"
#include "app/verbs/recover_tables.h"
#include "elastogear/base/error.h"
#include "elastogear/base/log_stage.h"
#include "elastogear/base/text.h"
#include "elastogear/drive/finite_elements.h"
#include "elastogear/io/body_file.h"
#include "elastogear/io/describe.h"
#include "elastogear/io/result_file.h"
#include "elastogear/io/stress_file.h"
#include "elastogear/recovery/contact_field.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::app {
namespace {

using recovery::RecoveredBody;

struct Run {
  std::string result;
  Eigen::VectorXd time;
  std::vector<RecoveredBody> bodies;
  std::set<std::string> rigid = {};  // bodies, which have no stresses
};

// Share of a list that lies before an item, 0 .. 1.
template <class Item>
double share(const std::vector<Item>& all, const Item& item) {
  return static_cast<double>(&item - all.data()) / static_cast<double>(all.size());
}

std::string stem(const std::string& path) { return std::filesystem::path(path).replace_extension().string(); }

// Bodies whose keys may be there: those of the result, and those of a file that it shares with simulate.
std::vector<std::string> known_bodies(const Options& options) {
  std::vector<std::string> names = options.list_with_files("bodies");
  for (const auto& body : io::read_result_header(options.text("result")).bodies) names.push_back(body.name);
  return names;
}

// Returns whether stresses of the body are wanted together with their estimated error.
bool needs_error(const RecoverSettings& settings, const std::string& body) {
  return (settings.stress.contains(body) || has_fields(settings)) && settings.error_estimate;
}

// Before the work: bodies and sets that the options name and the run has not.
void require_sets(const RecoverSettings& settings, const std::vector<recovery::BodyOfRun>& bodies) {
  for (const auto& [name, sets] : settings.stress) {
    const auto body = std::find_if(bodies.begin(), bodies.end(),
                                   [&, &name = name](const auto& one) { return one.name == name; });
    require(body != bodies.end(), "option -stress_", name, ": ", settings.result, " has no body '", name,
            "'; it has: ", join(bodies, ", ", &recovery::BodyOfRun::name));
    if (body->rigid || body->file.empty()) continue;
    const std::vector<std::string> known = io::read_stress_set_names(body->file);
    for (const std::string& set : sets) recovery::require_stress_set(known, set, body->file);
  }
}

Run prepared_run(const RecoverSettings& settings, const Eigen::VectorXd& time,
                 std::vector<recovery::BodyOfRun> bodies, const Progress& progress) {
  const LogStage stage("static responses of the run");
  Run run{settings.result, time, {}};
  for (recovery::BodyOfRun& body : bodies) {
    report(progress, "static responses", share(bodies, body));
    if (body.rigid) {
      run.rigid.insert(body.name);
      if (!body.file.empty() && io::read_body(body.file).n_q() > 0) continue;  // nor has it fields
    }
    const bool with_error = needs_error(settings, body.name);
    run.bodies.push_back(recovery::prepare_recovery(std::move(body), settings.mode_acceleration, with_error,
                                                    drive::finite_elements()));
  }
  report(progress, "static responses", 1);
  return run;
}

RecoveredBody& find_body(Run& run, const std::string& name) {
  const auto found = std::find_if(run.bodies.begin(), run.bodies.end(),
                                  [&](const RecoveredBody& body) { return body.run.name == name; });
  require(found != run.bodies.end(), "internal: ", run.result, " has no body '", name, "' to recover");
  return *found;
}

std::string table_path(const RecoverSettings& settings, const std::string& body, const std::string& set) {
  return stem(settings.output) + "_" + body + "_" + set + ".csv";
}

// That of the run, with what recover itself has been told: a stress file is of the torque that the run had.
std::map<std::string, std::string> provenance_of_stresses(const Options& options, const std::string& result) {
  std::map<std::string, std::string> all = io::read_provenance(result);
  const OptionTable own = recover_table();
  for (const auto& [key, value] : options.provenance()) {
    const bool of_option = key.starts_with("option_") || key.starts_with("in_files_");
    const std::size_t prefix = key.starts_with("option_") ? 7 : 9;
    if (!of_option || has(own, key.substr(prefix))) all[key] = value;
  }
  return all;
}

void write_stresses(const Options& options, const RecoverSettings& settings, Run& run,
                    const Progress& progress) {
  const LogStage stage("stresses");
  const std::optional<model::RunInput> input = io::read_run_input(settings.result);
  const StressTimes times{run.time, io::time_axis(input)};
  io::StressFile file{run.time, {}, provenance_of_stresses(options, settings.result), input};
  std::vector<const RecoveredBody*> owner;
  std::vector<std::string> without;
  double done = 0;
  for (const auto& [name, sets] : settings.stress) {
    report(progress, "stresses", done++ / static_cast<double>(settings.stress.size()));
    if (run.rigid.contains(name)) {
      without.push_back(name);
      continue;
    }
    RecoveredBody& body = find_body(run, name);
    const model::ElasticBody elastic = read_elastic_body(body.run);
    for (const std::string& set : sets) {
      file.sets.push_back(recover_stress(body, elastic, set, settings.error_estimate));
      owner.push_back(&body);
    }
  }
  require(!file.sets.empty() || without.empty(), run.result, ": no stresses of ", join(without),
          ", rigid in the run");
  require(!file.sets.empty(),
          "option -stress_<body> is missing: node sets whose stress histories are wanted, e.g. "
          "-stress_",
          run.bodies.front().run.name, " root");
  report(progress, "stresses", 1);
  for (const std::string& name : without) print_item("note", name + ": no stresses, it is rigid in the run");
  for (const auto& [body, response, reference, finite_elements] : run.bodies)
    if (const auto sets = settings.stress.find(body.name);
        !body.file.empty() && !body.rigid && (sets == settings.stress.end() || sets->second.empty()))
      print_item("not recovered", body.name + ": -stress_" + body.name + " names no sets");
  io::write_stress(settings.output, file);
  print_item("written", settings.output);
  for (std::size_t i = 0; i < file.sets.size(); ++i) {
    const io::StressSet& set = file.sets[i];
    print_stress(*owner[i], set, times);
    const std::string path = table_path(settings, set.body, set.set);
    write_table(path, set, times, settings.all_nodes);
    print_item("written", path);
  }
}

int nearest_step(const Eigen::VectorXd& time, double t) {
  require(t >= 0 && t <= time[time.size() - 1] * (1 + 1e-9), "option -field_times: ", t,
          " s is outside the run, 0 .. ", time[time.size() - 1], " s");
  Eigen::Index step = 0;
  (time.array() - t).abs().minCoeff(&step);
  return static_cast<int>(step);
}

std::vector<int> field_steps(const RecoverSettings& settings, const Eigen::VectorXd& time) {
  std::vector<int> steps;
  const int last = static_cast<int>(time.size()) - 1;
  for (int step = 0; settings.all_fields && step < last; step += settings.field_every) steps.push_back(step);
  if (settings.all_fields) steps.push_back(last);
  for (double t : settings.field_times) steps.push_back(nearest_step(time, t));
  return steps;
}

std::string field_path(const std::string& base, std::size_t i, std::size_t n) {
  return n == 1 ? base + ".vtu" : base + "_" + std::to_string(i) + ".vtu";
}

void write_fields(const RecoverSettings& settings, const Run& run, const std::vector<int>& steps,
                  const Progress& progress) {
  const LogStage stage("fields");
  std::vector<io::SeriesFile> series;
  for (const RecoveredBody& recovered : run.bodies) {
    const recovery::BodyOfRun& body = recovered.run;
    if (steps.empty()) return;
    if (body.file.empty()) continue;  // rigid, without a mesh
    const double before = share(run.bodies, recovered), each = 1.0 / static_cast<double>(run.bodies.size());
    const io::BodySource source = io::read_body_source(body.file);
    const model::ElasticBody elastic = read_elastic_body(body);
    const model::Surface& surface = elastic.surface;
    const bool tells_mesh = settings.error_estimate && tells_mesh_error(recovered, elastic);
    const recovery::BodyContact contact = recovery::read_body_contact(run.result, body.name, surface);
    const recovery::FieldBody of_body = field_body(
        body.file, source, tells_mesh ? std::optional(surface.node) : std::nullopt, drive::finite_elements());
    const std::string base = settings.fields + "_" + body.name;
    const int n_nodes = source.mesh.n_nodes(), together = recovery::fields_together(n_nodes);
    for (int first = 0; first < std::ssize(steps); first += together) {
      report(progress, "fields", before + each * first / static_cast<double>(steps.size()));
      const auto begin = steps.begin() + first;
      const std::vector<int> now(begin, begin + std::min<std::ptrdiff_t>(together, steps.end() - begin));
      std::vector<recovery::FieldState> states = recovered_states(recovered, now, settings.error_estimate);
      std::vector<std::string> paths;
      for (std::size_t i = 0; i < now.size(); ++i) {
        recovery::FieldState& state = states[i];
        state.more = contact_fields(contact, now[i], state.R_WB, surface, n_nodes);
        if (settings.error_estimate && body.history.q_error.size() > 0)
          state.q_error = body.history.q_error.col(now[i]);
        paths.push_back(field_path(base, static_cast<std::size_t>(first) + i, steps.size()));
        series.push_back({run.time[now[i]], std::filesystem::path(paths.back()).filename().string(),
                          static_cast<int>(&recovered - run.bodies.data()), body.name});
      }
      recovery::write_fields(paths, of_body, states);
      for (const std::string& path : paths) print_item("written", path);
    }
  }
  const std::string path = settings.fields + ".pvd";
  io::write_pvd(path, series);
  print_item("written", path);
  report(progress, "fields", 1);
}

void protect_inputs(const Options& options, const RecoverSettings& settings,
                    const std::vector<recovery::BodyOfRun>& bodies, std::size_t n_fields) {
  Outputs stresses{"output", {settings.output}}, fields{"fields", {settings.fields + ".pvd"}};
  for (const auto& [body, sets] : settings.stress)
    for (const std::string& set : sets) stresses.files.push_back(table_path(settings, body, set));
  std::vector<std::string> data = {settings.result};
  for (const recovery::BodyOfRun& body : bodies) {
    data.push_back(body.file);
    const std::string base = settings.fields + "_" + body.name;
    for (std::size_t i = 0; i < n_fields; ++i) fields.files.push_back(field_path(base, i, n_fields));
    for (const std::string& file : box_files(settings.fields, body.name)) fields.files.push_back(file);
  }
  protect_inputs(options, {stresses, fields}, data);
}

Options of_run(const Options& given) {
  const Options options = with_gears(given);
  if (!is_drive(options)) return options;
  const Options all = with_recovery(options, read_drive(options));
  require_input(options, all.text("result"));
  print_departures(options, {all.text("result")});
  return all;
}

OptionTable all_recover_options() {
  OptionTable table = recover_table();
  const OptionTable of_drives = whole_drive_table();
  table.insert(table.end(), of_drives.begin(), of_drives.end());
  return table;
}

void run_recover(const Options& given, const std::vector<std::string>&) {
  const Options options = of_run(given);
  options.reject_unknown({{"body", known_bodies(options)}});
  const RecoverSettings settings = recover_settings(options);
  const OutputLock lock(settings.output), lock_of_fields(settings.fields + ".pvd");
  const Progress progress = console_progress();
  const Eigen::VectorXd time = io::read_times(settings.result);
  if (!io::is_complete(settings.result))
    print_item("warning", settings.result + " is incomplete: its run did not reach the end");
  const std::vector<int> steps = field_steps(settings, time);
  std::vector<recovery::BodyOfRun> bodies = recovery::read_bodies_of_run(settings.result, settings.body_file);
  require_sets(settings, bodies);
  protect_inputs(options, settings, bodies, steps.size());
  Run run = prepared_run(settings, time, std::move(bodies), progress);
  write_stresses(options, settings, run, progress);
  write_fields(settings, run, steps, progress);
  write_trees(settings, run.bodies, steps.empty() ? 0 : steps.front());
}

}  // namespace

Verb recover_verb() {
  return {"recover", "recover system.yaml [-option value ...]",
          "stress histories, equivalent stresses and fields from a result file", all_recover_options(),
          run_recover};
}

}  // namespace elastogear::app
