// elastogear evaluate: drive file and results -> what an engineer reads off.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/console/plausibility.h"
#include "app/evaluate/cases.h"
#include "app/evaluate/evaluate_options.h"
#include "app/evaluate/evaluate_tables.h"
#include "app/evaluate/mesh_errors.h"
#include "app/gear/bearing_options.h"
#include "app/gear/drive_options.h"
#include "app/options/verbs.h"
#include "app/setup/drive_input.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/text.h"
#include "elastogear/io/describe.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::app {
namespace {

std::string stem_of(const std::string& output) {
  return std::filesystem::path(output).replace_extension().string();
}

std::string with_underscores(std::string name) {
  std::replace(name.begin(), name.end(), ':', '_');
  return name;
}

std::string tables_stem(const EvaluateSettings& settings, const CaseFigures& of, bool several,
                        const std::string& pair) {
  return stem_of(settings.output) + (several ? "_" + of.of.name : "") + "_" + with_underscores(pair);
}

// A drive whose results are evaluated, and how.
struct Task {
  const Options& options;
  EvaluateSettings settings;
  drive::DriveOfResults drive;
};

// One case with what evaluation gives besides items, by pair.
struct Evaluated {
  CaseFigures figures;
  std::vector<evaluation::PairEvaluation> pairs;
  std::vector<double> width;  // m
  std::vector<bool> touches;  // of each pair, at all positions
  Eigen::VectorXd roll;
};

std::string no_orders(const evaluation::PairOfRun& run) {
  if (run.time.size() == 0 && run.roll.size() == 1)
    return ": one roll angle alone: nothing here is the largest over a mesh; 'elastogear run' rolls over a "
           "pitch";
  return run.time.size() > 0
             ? ": no orders: the gears do not roll on over at least two pitches in this span of time"
             : ": no orders: the roll angles are not even positions that fill whole pitches";
}

void add_bearing(const evaluation::PairOfRun& run, const drive::BearingOfRun& bearing,
                 std::vector<io::EvaluationItem>& items) {
  const std::string group = "bearings/" + bearing.name + "/";
  items.push_back({group + "gear", "1", "gear that it supports", {1}, {}, {bearing.gear}});
  const auto add = [&](const char* name, const char* unit, const std::string& what,
                       const Eigen::VectorXd& values) {
    if (!(values.cwiseAbs().maxCoeff() > 0)) return;
    Eigen::Index at = 0;
    values.cwiseAbs().maxCoeff(&at);
    items.push_back({group + name,
                     unit,
                     what,
                     {static_cast<std::size_t>(values.size())},
                     {values.begin(), values.end()}});
    items.push_back({group + "largest_" + name, unit, what + ", of largest size", {}, {values[at]}});
    for (const io::EvaluationItem& item :
         evaluation::spectrum_items(run, group + name + "_orders", values, unit))
      items.push_back(item);
  };
  add("radial_load", "N", "radial load of the bearing", bearing.radial_load);
  add("axial_load", "N", "load on the bearing along the gear's z axis", bearing.axial_load);
  add("tilting_moment", "N m", "moment of the bearing across the axis", bearing.tilting_moment);
  add("radial_deflection", "m", "displacement of the gear across its axis at the bearing",
      bearing.radial_deflection);
  add("axial_deflection", "m", "displacement of the gear along its z axis at the bearing",
      bearing.axial_deflection);
  add("tilt", "rad", "tilt of the gear at the bearing", bearing.tilt);
}

// Without its torque means: next to nothing against that of the case.
constexpr double kLeastTorque = 0.01;

void require_unloaded(const Options& options, const Case& of) {
  const std::string file = options.text("unloaded");
  const double torque = torque_of_run(of.file), unloaded = torque_of_run(file);
  require(!(std::abs(unloaded) > kLeastTorque * std::abs(torque)), options.label("unloaded"), " = '", file,
          "': is a run under ", unloaded, " N m, ", of.file, " one under ", torque,
          " N m: name one under at most ", 100 * kLeastTorque, " % of the torque");
}

drive::DriveResult open_result(const Task& task, const std::string& file) {
  drive::DriveResult result = drive::open_result(file, task.settings.read);
  require_input(task.options, file);
  return result;
}

void warn_of_roots(const Task& task, const drive::DriveResult& result, const drive::DriveRun& run) {
  std::set<std::string> done;
  for (const drive::NamedPair& pair : run.pairs)
    for (const auto& root : pair.run.root)
      if (root && done.insert(root->body).second)
        warn_of_strain(*root, drive::body_file(task.drive, result, root->body));
}

Evaluated evaluate_case(const Task& task, drive::BodyFiles& bodies, const Case& of_case,
                        const drive::TransmissionErrors& unloaded) {
  const drive::DriveResult result = open_result(task, of_case.file);
  drive::DriveRun run = drive::read_result(task.drive, task.settings.read, result, bodies, unloaded);
  warn_of_roots(task, result, run);
  if (!unloaded.empty()) require_unloaded(task.options, of_case);
  Evaluated evaluated{{of_case, {}, {}, {}, std::move(run.notes)}, {}, {}, {}, run.pairs[0].run.roll};
  for (const drive::NamedPair& pair : run.pairs) {
    evaluated.touches.push_back(drive::touches_always(pair.run));
    evaluated.pairs.push_back(evaluation::evaluate(pair.run));
    evaluated.width.push_back(evaluation::common_width(pair.run));
    evaluated.figures.pairs.push_back({pair.name, evaluated.pairs.back().items});
    if (!find_item(evaluated.pairs.back().items, "transmission_error/order"))
      evaluated.figures.notes.push_back(pair.name + no_orders(pair.run));
  }
  for (const drive::BearingOfRun& bearing : run.bearings)
    add_bearing(run.pairs[0].run, bearing, evaluated.figures.bearings);
  constexpr const char* kAxis[] = {"x", "y", "z"};
  for (const auto& [sensor, a] : run.sensors)
    for (int i = 0; i < 3; ++i)
      for (const io::EvaluationItem& item : evaluation::spectrum_items(
               run.pairs[0].run, "sensors/" + sensor + "/acceleration_" + kAxis[i], a.col(i), "m/s^2"))
        evaluated.figures.sensors.push_back(item);
  return evaluated;
}

// The inputs of a case without its torque: two cases in which they are equal differ in their torque alone.
std::vector<std::string> other_inputs(const Case& of) {
  std::vector<std::string> texts;
  for (const auto& [heading, text] : of.columns)
    if (!heading.starts_with("torque") && heading != "positions") texts.push_back(text);
  return texts;
}

// The other case at the same positions whose torque alone differs, for which `off` of both torques is least;
// nullptr: there is none.
template <class Off>
const Evaluated* other_load(const std::vector<Evaluated>& cases, const Evaluated& of, const Off& off) {
  const double torque = number_in_column(of.figures.of, "torque");
  const Evaluated* best = nullptr;
  double least = INFINITY;
  for (const Evaluated& other : cases) {
    const double other_torque = number_in_column(other.figures.of, "torque");
    if (!(std::abs(other_torque - torque) > 0) || other.roll != of.roll ||
        other_inputs(other.figures.of) != other_inputs(of.figures.of))
      continue;
    if (off(torque, other_torque) < least) least = off(torque, other_torque), best = &other;
  }
  return best;
}

// Gears that do not touch stand at any angle and have no transmission error. Notes the case of such a pair.
bool both_touch(Evaluated& of, const Evaluated& other, std::size_t pair) {
  if (of.touches[pair] && other.touches[pair]) return true;
  const Evaluated& apart = of.touches[pair] ? other : of;
  of.figures.notes.push_back(of.figures.pairs[pair].pair + ": no stiffness against the case " +
                             other.figures.of.name + ": it does not touch at some position of the case " +
                             apart.figures.of.name);
  return false;
}

void append(const std::vector<io::EvaluationItem>& items, PairFigures& pair) {
  pair.items.insert(pair.items.end(), items.begin(), items.end());
}

// By the case of the next torque.
void add_tangents(const std::vector<Evaluated>& cases, Evaluated& of) {
  const Evaluated* next =
      other_load(cases, of, [](double torque, double other) { return std::abs(torque - other); });
  if (!next) return;
  for (std::size_t p = 0; p < of.pairs.size(); ++p)
    if (both_touch(of, *next, p))
      append(evaluation::tangent_stiffness(of.pairs[p], next->pairs[p], of.width[p]), of.figures.pairs[p]);
  of.figures.notes.push_back("tangent stiffness against the case " + next->figures.of.name);
}

// Adds the secant stiffness of drives with modified flanks, which needs the transmission error without load:
// it is that of a case whose torque is next to nothing.
void add_secants(const std::vector<Evaluated>& cases, Evaluated& of) {
  const Evaluated* least = other_load(cases, of, [](double, double other) { return std::abs(other); });
  const double torque = std::abs(number_in_column(of.figures.of, "torque"));
  if (!least || std::abs(number_in_column(least->figures.of, "torque")) > kLeastTorque * torque) return;
  for (std::size_t p = 0; p < of.pairs.size(); ++p)
    if (!find_item(of.figures.pairs[p].items, "transmission_error/unloaded") && both_touch(of, *least, p))
      append(evaluation::unloaded_items(of.pairs[p], least->pairs[p].error, of.width[p]),
             of.figures.pairs[p]);
}

// Headings hold units, "N/m", which would be groups in a path.
void add_case_inputs(const Case& of, io::EvaluationFile& file) {
  std::vector<std::string> headings, texts;
  for (const auto& [heading, text] : of.columns) headings.push_back(heading), texts.push_back(text);
  if (headings.empty()) return;
  const std::vector<std::size_t> shape = {headings.size()};
  file.items.push_back({of.name + "/inputs/heading", "1", "columns of cases.csv", shape, {}, headings});
  file.items.push_back({of.name + "/inputs/text", "1", "what they hold", shape, {}, texts});
}

io::EvaluationFile file_of(const Options& options, const std::vector<CaseFigures>& cases) {
  io::EvaluationFile file{{}, options.provenance()};
  const auto add = [&](const std::string& group, const std::vector<io::EvaluationItem>& items) {
    for (io::EvaluationItem item : items) {
      item.path = group + "/" + item.path;
      file.items.push_back(std::move(item));
    }
  };
  for (const CaseFigures& of : cases) {
    for (const auto& [key, identity] : io::read_provenance(of.of.file))
      if (key.starts_with(model::identity_key(""))) file.provenance[key] = identity;
    file.items.push_back({of.of.name + "/result", "1", "result file of the case", {1}, {}, {of.of.file}});
    add_case_inputs(of.of, file);
    for (const PairFigures& pair : of.pairs) add(of.of.name + "/" + pair.pair, pair.items);
    add(of.of.name, of.bearings);
    add(of.of.name, of.sensors);
  }
  return file;
}

std::vector<NamedTable> tables_of(const EvaluateSettings& settings, const std::vector<CaseFigures>& cases) {
  const bool several = cases.size() > 1;
  std::vector<NamedTable> all;
  const auto add = [&](std::vector<NamedTable> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  };
  for (const CaseFigures& of : cases) {
    if (several && !settings.case_tables) break;
    for (const PairFigures& pair : of.pairs)
      add(pair_tables(tables_stem(settings, of, several, pair.pair), pair.items));
    add(bearing_tables(stem_of(settings.output) + (several ? "_" + of.of.name : ""), of));
  }
  return all;
}

void write_all(const Options& options, const EvaluateSettings& settings,
               const std::vector<CaseFigures>& cases) {
  const std::string stem = stem_of(settings.output);
  const std::vector<NamedTable> tables = tables_of(settings, cases);
  for (const NamedTable& table : tables) place_of_output(table.path);  // an Error before anything is written
  io::write_evaluation(settings.output, file_of(options, cases));
  print_detail("written", settings.output);
  write_summary(stem + ".json", drive_stem(options), cases);
  print_detail("written", stem + ".json");
  if (cases.size() > 1) {
    write_cases_table(stem + "_cases.csv", cases);
    print_item("written", stem + "_cases.csv");
  }
  for (const NamedTable& table : tables) io::write_csv(table.path, table.columns);
  print_item("written", stem + ".json (all numbers, for programs), " + settings.output + ", " +
                            std::to_string(tables.size()) + " tables " + stem + "_*.csv");
}

// Tables are named after the output and cannot be inputs unless these end in .csv or .json.
void protect(const Options& options, const EvaluateSettings& settings, const std::vector<Case>& cases) {
  std::vector<std::string> data;
  for (const Case& of : cases) data.push_back(of.file);
  if (!settings.unloaded.empty()) data.push_back(settings.unloaded);
  const std::string stem = stem_of(settings.output);
  protect_inputs(options, {{"output", {settings.output, stem + ".json", stem + "_cases.csv"}}}, data);
}

std::string without_number(std::string name) {
  while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back()))) name.pop_back();
  if (name.ends_with('_')) name.pop_back();
  return name;
}

// Gears whose names differ in their numbers alone and that are equal, between the same mates.
std::map<std::string, std::string> kinds_of(const drive::Drive& drive) {
  using Likeness = std::pair<std::string, std::vector<double>>;
  std::map<Likeness, std::vector<std::string>> alike;
  for (std::size_t i = 0; i < drive.members.size(); ++i) {
    const DriveMember& m = drive.members[i];
    const gear::Toothing& t = m.toothing;
    Likeness of{without_number(m.name), {static_cast<double>(t.z), t.r_a, t.r_f, t.r_form, t.psi_b, m.width}};
    for (const DrivePair& pair : drive.pairs) {
      if (pair.first == static_cast<int>(i)) of.second.push_back(pair.second);
      if (pair.second == static_cast<int>(i)) of.second.push_back(pair.first);
    }
    alike[of].push_back(m.name);
  }
  std::map<std::string, std::string> kinds;
  for (const auto& [of, names] : alike)
    if (names.size() > 1 && !of.first.empty())
      for (const std::string& name : names) kinds[name] = of.first;
  return kinds;
}

std::string finer_size(const Options& options) {
  constexpr const char* kSizes[] = {"tiny", "small", "medium", "paper", ""};
  const std::string size = options.text("size");
  for (std::size_t i = 0; i + 1 < std::size(kSizes); ++i)
    if (size == kSizes[i]) return kSizes[i + 1];
  return "";
}

void print_all(const Task& task, const std::vector<CaseFigures>& figures) {
  if (figures.size() > 1) return print_cases(figures);
  if (is_verbose()) return print_figures(figures[0]);
  print_case_in_short(figures[0], {kinds_of(task.drive.drive), task.drive.coasts ? "coast" : "drive",
                                   finer_size(task.options), !task.settings.coarser.empty()});
}

OptionTable all_evaluate_options() {
  OptionTable table = evaluate_table();
  const OptionTable of_drives = whole_drive_table();
  table.insert(table.end(), of_drives.begin(), of_drives.end());
  return table;
}

// Gears, and what else a file for simulate has: shafts, couplings.
std::vector<std::string> gears_and_bodies(const Options& options) {
  std::vector<std::string> names = options.list("gears");
  for (const std::string& name : options.list_with_files("bodies")) names.push_back(name);
  return names;
}

Task task_of(const Options& options) {
  Options at_zero = options;
  at_zero.set("roll", "0");
  Task task{options, evaluate_settings(options), {read_drive(at_zero), drive_start(options).coasts}};
  for (const DriveMember& member : task.drive.drive.members)
    task.drive.bearings.push_back(bearings(options, member));
  task.drive.body_file = task.settings.body_file;
  if (options.given("speed")) task.drive.speed = options.number("speed");
  return task;
}

void run_evaluate(const Options& given, const std::vector<std::string>&) {
  require_drive(given, "evaluate");
  const Options options = with_evaluation(with_gears(given));
  options.reject_unknown({{"body", gears_and_bodies(options)}});
  const Task task = task_of(options);
  const EvaluateSettings& settings = task.settings;
  const std::vector<Case> all = read_cases(settings.result);
  protect(options, settings, all);
  const OutputLock lock(settings.output, PETSC_COMM_SELF);
  const Progress progress = console_progress();
  drive::BodyFiles bodies;
  drive::TransmissionErrors unloaded;
  if (!settings.unloaded.empty())
    unloaded = drive::transmission_errors(task.drive, open_result(task, settings.unloaded), bodies);
  std::vector<Evaluated> cases;
  for (const Case& of_case : all) {
    report(progress, "cases", static_cast<double>(cases.size()) / static_cast<double>(all.size()));
    cases.push_back(evaluate_case(task, bodies, of_case, unloaded));
  }
  report(progress, "cases", 1);
  for (Evaluated& one : cases) {
    add_tangents(cases, one);
    add_secants(cases, one);
  }
  std::vector<CaseFigures> figures;
  for (Evaluated& one : cases) figures.push_back(std::move(one.figures));
  add_mesh_errors(settings.coarser, options.positive("refinement"), figures);
  std::vector<std::string> files;
  for (const Case& of_case : all) files.push_back(of_case.file);
  print_departures(options, files);
  print_all(task, figures);
  write_all(options, settings, figures);
}

}  // namespace

Verb evaluate_verb() {
  return {"evaluate", "evaluate drive.yaml [-option value ...]",
          "what an engineer reads off the results of a drive", all_evaluate_options(), run_evaluate};
}

}  // namespace elastogear::app
