// elastogear recover: result file -> stress histories, fields, pictures of the trees.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/contact_field.h"
#include "app/field.h"
#include "app/resumable_run.h"
#include "app/static_response.h"
#include "app/verbs/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/io/csv.h"
#include "elastogear/io/polydata_file.h"
#include "elastogear/io/result_file.h"
#include "elastogear/io/stress_file.h"
#include "elastogear/recovery/boxes.h"
#include "elastogear/recovery/error_estimate.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::app {
namespace {

constexpr const char *kBoxes = "kdops", *kOverlaps = "overlaps";  // in the names of files
constexpr int kSmallSet = 10;  // nodes; larger sets go to CSV with their peak node only

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

struct Body {
  std::string result, name, file, identity;
  io::BodyHistory history;
  std::unique_ptr<StaticResponseOfRun> response = nullptr;  // of mode acceleration, when asked for
  std::unique_ptr<StaticResponseOfRun> reference =
      nullptr;  // of the error estimate, where `response` is none

  BodyOfRun of_run() const { return {result, name, file, identity, history}; }
  const Eigen::MatrixXd& q() const { return response ? response->q : history.q; }
};

struct Run {
  std::string result;
  Eigen::VectorXd time;
  std::vector<Body> bodies;
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
  for (const auto& body : header.bodies) {
    const std::string key = body.name + "_file";
    const auto known = header.provenance.find(identity_key(body.name));
    run.bodies.push_back({run.result, body.name, options.given(key) ? options.text(key) : body.file,
                          known == header.provenance.end() ? "" : known->second,
                          io::read_body_history(run.result, body.name)});
  }
  const auto acceleration =
      static_cast<Acceleration>(options.choice("mode_acceleration", {"false", "auto", "true"}));
  for (Body& body : run.bodies) {
    report(progress, "static responses", share(run.bodies, body));
    body.response = static_response_of_run(body.of_run(), acceleration);
    if (!body.response && is_asked(options, body.name)) body.reference = error_reference(body.of_run());
  }
  report(progress, "static responses", 1);
  return run;
}

Body& find_body(Run& run, const std::string& name) {
  std::string known;
  for (Body& body : run.bodies) {
    if (body.name == name) return body;
    known += (known.empty() ? "" : ", ") + body.name;
  }
  fail("option -stress_", name, ": ", run.result, " has no body '", name, "'; it has: ", known);
}

model::ElasticBody read_elastic(const Body& body) {
  require(!body.file.empty(), "body '", body.name, "' of ", body.result,
          " is rigid and has no file: it has no stresses and no fields");
  model::ElasticBody elastic = io::read_body(body.file);
  require_body_of_run(elastic, body.of_run());
  return elastic;
}

const std::vector<int>& stress_set(const model::Stress& stress, const std::string& set,
                                   const std::string& file) {
  const auto found = stress.sets.find(set);
  std::string known;
  for (const auto& [name, members] : stress.sets) known += (known.empty() ? "" : ", ") + name;
  require(found != stress.sets.end(), file, ": no stress modes at the set '", set,
          "'; there are: ", known.empty() ? "none" : known, ". Name it in -stress_nodes of reduce");
  return found->second;
}

// Position (node, time) of the largest von Mises stress.
std::pair<Eigen::Index, Eigen::Index> peak(const io::StressSet& set) {
  Eigen::Index node = 0, time = 0;
  if (set.von_mises.size() > 0) set.von_mises.maxCoeff(&node, &time);
  return {node, time};
}

constexpr double kTrusted = 0.05;  // of the peak

// Advice for stresses whose estimated error is too large.
std::string remedy(const Body& body) {
  const bool untouched = body.reference && body.reference->node.empty();
  if (!body.response && !untouched)
    return "reduce the body with -basis modal_residual, loaded wherever it is touched (option loaded; by "
           "default "
           "everywhere)";
  return "reduce the body with more modes (-modes)";
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
  return text;
}

void print_error(const Body& body, const io::StressSet& set) {
  const auto [node, step] = peak(set);
  if (set.error.size() == 0)
    return print_item("", "error of the reduction not estimated: not to be trusted; " + remedy(body));
  const double share = set.peak_error[step] / std::max(set.von_mises(node, step), 1e-300);
  print_item("", "estimated error of the reduction " + with_unit(1e-6 * set.peak_error[step], "MPa") + ", " +
                     percent(share));
  if (share > kTrusted)
    print_item("warning", set.body + " " + set.set + ": not to be trusted; " + remedy(body));
}

void print_peak(const io::StressSet& set, const Eigen::VectorXd& time) {
  const auto [node, step] = peak(set);
  print_item(set.body + " " + set.set,
             "peak von Mises " + with_unit(1e-6 * set.von_mises(node, step), "MPa") + " at node " +
                 std::to_string(set.node[node]) + ", " + with_unit(time[step], "s"));
}

void add_columns(std::vector<io::CsvColumn>& columns, const io::StressSet& set, Eigen::Index node) {
  const char* components[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  const std::string suffix = " node " + std::to_string(set.node[node]);
  for (int c = 0; c < 6; ++c) columns.push_back({components[c] + suffix, "Pa", set.stress.row(6 * node + c)});
  columns.push_back({"von_mises" + suffix, "Pa", set.von_mises.row(node)});
  columns.push_back({"rankine" + suffix, "Pa", set.rankine.row(node)});
  if (set.error.size() > 0) columns.push_back({"error of von_mises" + suffix, "Pa", set.error.row(node)});
}

void write_table(const std::string& path, const io::StressSet& set, const Eigen::VectorXd& time, bool all) {
  std::vector<io::CsvColumn> columns = {{"time", "s", time}};
  if (all || set.node.size() <= kSmallSet)
    for (std::size_t node = 0; node < set.node.size(); ++node) add_columns(columns, set, node);
  else
    add_columns(columns, set, peak(set).first);
  io::write_csv(path, columns);
}

recovery::StressHistory history(Body& body, const model::Stress& stress, const std::string& set) {
  const std::vector<int>& members = stress_set(stress, set, body.file);
  std::vector<int> nodes;
  for (int member : members) nodes.push_back(stress.node[member]);
  const Eigen::MatrixXd sigma_static =
      body.response ? stress_history(*body.response, nodes) : Eigen::MatrixXd();
  return recovery::stress_history(stress, members, body.q(), sigma_static);
}

// The stress of the whole static response less that of the modes, which mode acceleration has added to `set`.
// Eq. (4.6).
Eigen::MatrixXd residual_stress(Body& body, const model::Stress& stress, const std::vector<int>& members,
                                const io::StressSet& set) {
  const Eigen::MatrixXd& q = body.history.q;
  if (body.response) return set.stress - recovery::modal_stress(stress, members, q);
  const Eigen::MatrixXd whole = stress_history(*body.reference, set.node);
  const Eigen::MatrixXd of_modes = recovery::modal_stress(stress, members, q - body.reference->q);
  return whole.size() > 0 ? Eigen::MatrixXd(whole - of_modes) : Eigen::MatrixXd(-of_modes);
}

// Sets `error` where it can be told: the full basis leaves nothing out.
void estimate_error(Body& body, const model::ElasticBody& elastic, io::StressSet& set) {
  if (elastic.basis == model::Basis::full) {
    set.error.setZero(set.von_mises.rows(), set.von_mises.cols());
    set.peak_error.setZero(set.von_mises.cols());
    return;
  }
  StaticResponseOfRun* const reference = body.response ? body.response.get() : body.reference.get();
  if (!reference) return;
  const std::vector<int>& members = elastic.stress.sets.at(set.set);
  const Eigen::MatrixXd q_s = body.history.q - reference->q;
  auto error = recovery::reduction_error(
      elastic, members, {reference->q, q_s},
      {set.stress, residual_stress(body, elastic.stress, members, set), body.response != nullptr});
  set.error = std::move(error.at_node);
  set.peak_error = std::move(error.of_peak);
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
  io::StressHistory file{run.time, {}, options.provenance()};
  std::vector<const Body*> owner;
  const bool all = options.choice("csv", {"peak", "all"}) == 1;
  const std::vector<std::string> names = stressed_bodies(options);
  for (const std::string& name : names) {
    report(progress, "stresses", share(names, name));
    Body& body = find_body(run, name);
    const model::ElasticBody elastic = read_elastic(body);
    const model::Stress& stress = elastic.stress;
    for (const std::string& set : options.list("stress_" + name)) {
      auto h = history(body, stress, set);
      file.sets.push_back({name, set, std::move(h.node), std::move(h.stress), std::move(h.von_mises),
                           std::move(h.rankine), stress.X(Eigen::all, stress.sets.at(set))});
      owner.push_back(&body);
      if (options.flag("error_estimate")) estimate_error(body, elastic, file.sets.back());
    }
  }
  require(!file.sets.empty(),
          "option -stress_<body> is missing: node sets whose stress histories are wanted, e.g. "
          "-stress_",
          run.bodies.front().name, " root");
  report(progress, "stresses", 1);
  for (const Body& body : run.bodies)
    if (!body.file.empty() && options.list("stress_" + body.name).empty())
      print_item("not recovered", body.name + ": -stress_" + body.name + " names no sets");
  io::write_stress(output, file);
  print_item("written", output);
  for (std::size_t i = 0; i < file.sets.size(); ++i) {
    const io::StressSet& set = file.sets[i];
    print_peak(set, run.time);
    print_error(*owner[i], set);
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

FieldState state_at(const Body& body, int step) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(body.history.R_WB.col(step).data());
  return {body.history.r_WB.col(step), R, body.history.q.col(step)};
}

// State for a field, with the whole body's static response in place of that of the modes when it was asked
// for.
FieldState recovered_state(const Options& options, const Body& body, int step) {
  FieldState state = state_at(body, step);
  StaticResponseOfRun* const known = body.response ? body.response.get() : body.reference.get();
  if (!known) return state;
  const Eigen::VectorXd u_static = displacement(*known, step), q_d = known->q.col(step);
  if (options.flag("error_estimate")) {
    const Eigen::VectorXd share = recovery::dynamic_share(known->body, {q_d, state.q - q_d});
    state.reference = {state.q, q_d, u_static, share[0]};
  }
  if (!body.response) return state;
  state.q = q_d;
  state.u_static = u_static;
  return state;
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
  for (const Body& body : run.bodies) {
    if (steps.empty()) break;
    if (body.file.empty()) continue;  // rigid, without a mesh
    const double before = share(run.bodies, body), each = 1.0 / static_cast<double>(run.bodies.size());
    const io::BodySource source = io::read_body_source(body.file);
    const model::Surface surface = read_elastic(body).surface;
    const BodyContact contact = read_body_contact(run.result, body.name, surface);
    const std::string base = field_prefix(options) + "_" + body.name;
    std::vector<io::TimeStep> series;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      report(progress, "fields", before + each * share(steps, steps[i]));
      const std::string path = field_path(base, i, steps.size());
      FieldState state = recovered_state(options, body, steps[i]);
      state.more = contact_fields(contact, steps[i], state.R_WB, surface, source.mesh.X.cols());
      write_field(path, body.file, source, state);
      series.push_back({run.time[steps[i]], std::filesystem::path(path).filename().string()});
      print_item("written", path);
    }
    io::write_pvd(base + ".pvd", series);
  }
  if (!steps.empty()) report(progress, "fields", 1);
}

std::vector<int> box_levels(const Options& options) {
  std::vector<int> levels;
  for (const std::string& level : options.list("box_levels")) {
    const bool number =
        !level.empty() && level.size() < 4 && std::all_of(level.begin(), level.end(), isdigit);
    require(number || level == "leaf", "option -box_levels = '", level,
            "': must be a level 0, 1, ... or leaf");
    levels.push_back(number ? std::stoi(level) : std::numeric_limits<int>::max());
  }
  return levels;
}

std::string box_path(const Options& options, const Body& body, const char* kind) {
  return field_prefix(options) + "_" + body.name + "_" + kind + ".vtp";
}

void write_boxes(const std::string& path, const recovery::Boxes& boxes) {
  io::write_polydata(path, boxes.points, boxes.polygons,
                     {{"level", boxes.level}, {"overlaps", boxes.overlaps}});
  print_item("written", path);
}

// k-DOPs of all bodies in the world frame; with two bodies also the leaves that overlap (the paper's Fig. 4).
void write_trees(const Options& options, const Run& run, const std::vector<int>& levels, int step) {
  if (levels.empty()) return;
  std::vector<contact::Bvh> trees;
  for (const Body& body : run.bodies) {
    const model::Surface surface = read_elastic(body).surface;
    const FieldState state = state_at(body, step);
    Eigen::Matrix3Xd x = surface.X;
    Eigen::Map<Eigen::VectorXd>(x.data(), x.size()) += model::multiply(surface.Phi, state.q);
    x = ((state.R_WB * x).colwise() + state.r_WB).eval();
    trees.push_back(recovery::fitted_tree(surface, x, options.count("box_kdop")));
    write_boxes(box_path(options, body, kBoxes), recovery::boxes_at_levels(trees.back(), levels));
  }
  if (trees.size() != 2) return;
  for (int i : {0, 1})
    write_boxes(box_path(options, run.bodies[i], kOverlaps),
                recovery::overlapping_boxes(trees[i], trees[1 - i]));
}

void protect_inputs(const Options& options, const Run& run, std::size_t n_fields) {
  Outputs stresses{"output", {options.text("output")}}, fields{"fields", {}};
  for (const std::string& name : stressed_bodies(options))
    for (const std::string& set : options.list("stress_" + name))
      stresses.files.push_back(table_path(options, name, set));
  std::vector<std::string> data = {run.result};
  for (const Body& body : run.bodies) {
    data.push_back(body.file);
    const std::string base = field_prefix(options) + "_" + body.name;
    fields.files.push_back(base + ".pvd");
    for (std::size_t i = 0; i < n_fields; ++i) fields.files.push_back(field_path(base, i, n_fields));
    for (const char* kind : {kBoxes, kOverlaps}) fields.files.push_back(box_path(options, body, kind));
  }
  protect_inputs(options, {stresses, fields}, data);
}

void run(const Options& options, const std::vector<std::string>&) {
  options.text("result");
  options.choice("box_kdop", {"6", "14", "18", "24", "26"});
  const OutputLock lock(options.text("output"));
  const Progress progress = console_progress();
  Run run = read_run(options, progress);
  const std::vector<int> steps = field_steps(options, run), levels = box_levels(options);
  protect_inputs(options, run, steps.size());
  write_stresses(options, run, progress);
  write_fields(options, run, steps, progress);
  write_trees(options, run, levels, steps.empty() ? 0 : steps.front());
}

}  // namespace

Verb recover_verb() {
  return {"recover", "recover system.yaml [-option value ...]",
          "stress histories, equivalent stresses and fields from a result file", kTable, run};
}

}  // namespace elastogear::app
