// elastogear recover: result file -> stress histories, fields, pictures of the trees.

#include <filesystem>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/finite_elements.h"
#include "app/verbs/recover_boxes.h"
#include "app/verbs/recover_tables.h"
#include "app/verbs/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/io/result_file.h"
#include "elastogear/io/stress_file.h"
#include "elastogear/recovery/contact_field.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::app {
namespace {

using recovery::RecoveredBody;

const OptionTable kTable = {
    {"result", "-", "", "result file of simulate"},
    {"output", "-", "", "stress file to write (HDF5); CSV tables are named after it"},
    {"stress_<body>", "-", "", "node sets of a body whose stress histories are wanted (of its stress_nodes)"},
    {"csv", "-", "peak", "nodes in the CSV tables of sets above 10 nodes: peak (largest von Mises) or all"},
    {"field_times", "s", "", "times at which fields of whole bodies are written for ParaView"},
    {"fields", "-", "", "first part of the field files' names (default: the result file without .h5)"},
    {"box_levels", "-", "",
     "levels of the bounding-volume trees to write at the first field time: 0, 1, ... or leaf"},
    {"box_kdop", "-", "24", "directions of those bounding volumes"},
    {"mode_acceleration", "-", "auto",
     "add what the modes leave out of the response to contact forces, statically: true, false, or auto, for "
     "bodies "
     "reduced with -basis modal_residual; true takes a factor of each other body's stiffness matrix, and so "
     "do "
     "fields"},
    {"error_estimate", "-", "true",
     "estimate how far stresses are from those of the unreduced body on the same mesh; takes a factor of the "
     "stiffness matrix of bodies without static responses to the contact forces (up to 500,000 "
     "displacements)"},
    {"<body>_file", "-", "", "body file, when it is no longer where the result file says"},
};

struct Run {
  std::string result;
  Eigen::VectorXd time;
  std::vector<RecoveredBody> bodies;
};

// Share of a list that lies before an item, 0 .. 1.
template <class Item>
double share(const std::vector<Item>& all, const Item& item) {
  return static_cast<double>(&item - all.data()) / static_cast<double>(all.size());
}

std::string stem(const std::string& path) { return std::filesystem::path(path).replace_extension().string(); }

// Returns whether stresses of the body are wanted together with their estimated error.
bool is_asked(const Options& options, const std::string& body) {
  return (options.given("stress_" + body) || options.given("field_times")) && options.flag("error_estimate");
}

Run read_run(const Options& options, const Progress& progress) {
  Run run{options.text("result"), {}, {}};
  if (!io::is_complete(run.result))
    print_item("warning", run.result + " is incomplete: its run did not reach the end");
  const model::ResultHeader header = io::read_result_header(run.result);
  run.time = io::read_times(run.result);
  std::vector<std::string> names = options.list_with_files("bodies");
  for (const auto& body : header.bodies) names.push_back(body.name);
  options.reject_unknown({{"body", names}});
  std::map<std::string, std::string> files;
  for (const auto& body : header.bodies)
    if (const std::string key = body.name + "_file"; options.given(key)) files[body.name] = options.text(key);
  const auto acceleration =
      static_cast<recovery::Acceleration>(options.choice("mode_acceleration", {"false", "auto", "true"}));
  std::vector<recovery::BodyOfRun> bodies = recovery::read_bodies_of_run(run.result, files);
  for (recovery::BodyOfRun& body : bodies) {
    report(progress, "static responses", share(bodies, body));
    const bool with_error = is_asked(options, body.name);
    run.bodies.push_back(
        recovery::prepare_recovery(std::move(body), acceleration, with_error, finite_elements()));
  }
  report(progress, "static responses", 1);
  return run;
}

RecoveredBody& find_body(Run& run, const std::string& name) {
  std::string known;
  for (RecoveredBody& body : run.bodies) {
    if (body.run.name == name) return body;
    known += (known.empty() ? "" : ", ") + body.run.name;
  }
  fail("option -stress_", name, ": ", run.result, " has no body '", name, "'; it has: ", known);
}

std::string table_path(const Options& options, const std::string& body, const std::string& set) {
  return stem(options.text("output")) + "_" + body + "_" + set + ".csv";
}

// Bodies whose stresses are wanted; stress_nodes is reduce's key in a shared file.
std::vector<std::string> stressed_bodies(const Options& options) {
  std::vector<std::string> names = options.placeholder_values("stress_<body>");
  std::erase(names, "nodes");
  return names;
}

void write_stresses(const Options& options, Run& run, const Progress& progress) {
  const std::string output = options.text("output");
  io::StressFile file{run.time, {}, options.provenance()};
  std::vector<const RecoveredBody*> owner;
  const bool all = options.choice("csv", {"peak", "all"}) == 1;
  const std::vector<std::string> names = stressed_bodies(options);
  for (const std::string& name : names) {
    report(progress, "stresses", share(names, name));
    RecoveredBody& body = find_body(run, name);
    const model::ElasticBody elastic = read_elastic_body(body.run);
    for (const std::string& set : options.list("stress_" + name)) {
      file.sets.push_back(recover_stress(body, elastic, set, options.flag("error_estimate")));
      owner.push_back(&body);
    }
  }
  require(!file.sets.empty(),
          "option -stress_<body> is missing: node sets whose stress histories are wanted, e.g. "
          "-stress_",
          run.bodies.front().run.name, " root");
  report(progress, "stresses", 1);
  for (const auto& [body, response, reference] : run.bodies)
    if (!body.file.empty() && options.list("stress_" + body.name).empty())
      print_item("not recovered", body.name + ": -stress_" + body.name + " names no sets");
  io::write_stress(output, file);
  print_item("written", output);
  for (std::size_t i = 0; i < file.sets.size(); ++i) {
    const io::StressSet& set = file.sets[i];
    print_stress(*owner[i], set, run.time);
    const std::string path = table_path(options, set.body, set.set);
    write_table(path, set, run.time, all);
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

std::string field_prefix(const Options& options) {
  return options.given("fields") ? options.text("fields") : stem(options.text("result"));
}

std::vector<int> field_steps(const Options& options, const Run& run) {
  std::vector<int> steps;
  for (double time : options.numbers("field_times")) steps.push_back(nearest_step(run.time, time));
  return steps;
}

std::string field_path(const std::string& base, std::size_t i, std::size_t n) {
  return n == 1 ? base + ".vtu" : base + "_" + std::to_string(i) + ".vtu";
}

void write_fields(const Options& options, const Run& run, const std::vector<int>& steps,
                  const Progress& progress) {
  for (const RecoveredBody& recovered : run.bodies) {
    const recovery::BodyOfRun& body = recovered.run;
    if (steps.empty()) break;
    if (body.file.empty()) continue;  // rigid, without a mesh
    const double before = share(run.bodies, recovered), each = 1.0 / static_cast<double>(run.bodies.size());
    const io::BodySource source = io::read_body_source(body.file);
    const model::Surface surface = read_elastic_body(body).surface;
    const recovery::BodyContact contact = recovery::read_body_contact(run.result, body.name, surface);
    const std::string base = field_prefix(options) + "_" + body.name;
    std::vector<io::TimeStep> series;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      report(progress, "fields", before + each * share(steps, steps[i]));
      const std::string path = field_path(base, i, steps.size());
      recovery::FieldState state = recovered_state(recovered, steps[i], options.flag("error_estimate"));
      state.more = contact_fields(contact, steps[i], state.R_WB, surface, source.mesh.X.cols());
      write_field(path, body.file, source, state, finite_elements());
      series.push_back({run.time[steps[i]], std::filesystem::path(path).filename().string()});
      print_item("written", path);
    }
    io::write_pvd(base + ".pvd", series);
  }
  if (!steps.empty()) report(progress, "fields", 1);
}

void protect_inputs(const Options& options, const Run& run, std::size_t n_fields) {
  Outputs stresses{"output", {options.text("output")}}, fields{"fields", {}};
  for (const std::string& name : stressed_bodies(options))
    for (const std::string& set : options.list("stress_" + name))
      stresses.files.push_back(table_path(options, name, set));
  std::vector<std::string> data = {run.result};
  for (const auto& [body, response, reference] : run.bodies) {
    data.push_back(body.file);
    const std::string base = field_prefix(options) + "_" + body.name;
    fields.files.push_back(base + ".pvd");
    for (std::size_t i = 0; i < n_fields; ++i) fields.files.push_back(field_path(base, i, n_fields));
    for (const std::string& file : box_files(field_prefix(options), body.name)) fields.files.push_back(file);
  }
  protect_inputs(options, {stresses, fields}, data);
}

void run(const Options& options, const std::vector<std::string>&) {
  options.text("result");
  options.choice("box_kdop", {"6", "14", "18", "24", "26"});
  const OutputLock lock(options.text("output"));
  const Progress progress = console_progress();
  Run run = read_run(options, progress);
  const std::vector<int> steps = field_steps(options, run);
  box_levels(options);  // refused before the work
  protect_inputs(options, run, steps.size());
  write_stresses(options, run, progress);
  write_fields(options, run, steps, progress);
  write_trees(options, field_prefix(options), run.bodies, steps.empty() ? 0 : steps.front());
}

}  // namespace

Verb recover_verb() {
  return {"recover", "recover system.yaml [-option value ...]",
          "stress histories, equivalent stresses and fields from a result file", kTable, run};
}

}  // namespace elastogear::app
