#include "app/setup/drive_input.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <set>

#include "app/console/console.h"
#include "app/gear/cylindrical_options.h"
#include "app/gear/design_options.h"
#include "app/gear/worm_options.h"
#include "app/options/input_differences.h"
#include "app/options/verbs.h"
#include "app/setup/resumable_run.h"
#include "app/tables/reduce_options.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/base/text.h"
#include "elastogear/io/describe.h"

namespace elastogear::app {
namespace {

using Provenance = std::map<std::string, std::string>;

// Options of reduce on which its bodies do not depend: files, and how the modes are found.
constexpr const char* kOfReduceAlone[] = {"mesh",         "nodes",  "unit",    "output",
                                          "completeness", "window", "symmetry"};

bool is_of_reduction(const std::string& name) {
  static const OptionTable table = reduce_table();
  if (name == "eps_nev" || name == "eps_interval") return true;  // SLEPc's names of modes
  return has(table, name) &&
         std::find(std::begin(kOfReduceAlone), std::end(kOfReduceAlone), name) == std::end(kOfReduceAlone);
}

bool is_mesh_density(const std::string& name) {
  return name == "size" || name == "element_order" || name == "refinement";
}

// Options that say what the gears are and where: all verbs derive them anew.
bool is_of_design(const std::string& name) {
  static const OptionTable tables[] = {cylindrical_table(), worm_table(), table_of(design_rows())};
  if (name == "drive" || name == "gears") return true;
  if (name == "part" || name == "mesh" || is_mesh_density(name)) return false;
  return std::any_of(std::begin(tables), std::end(tables),
                     [&](const auto& table) { return has(table, name); });
}

Weight weight_for_bodies(const std::string& name) {
  if (is_of_design(name)) return Weight::always;
  return is_of_reduction(name) || is_mesh_density(name) ? Weight::of_files : Weight::none;
}

// Of gears' own sections, too: "pinion_modes".
bool is_of_a_body(const Options& options, const std::string& name) {
  if (is_of_reduction(name)) return true;
  const std::vector<std::string> gears = options.list("gears");
  return std::any_of(gears.begin(), gears.end(), [&](const std::string& gear) {
    return name.starts_with(gear + "_") && is_of_reduction(name.substr(gear.size() + 1));
  });
}

Weight weight_for_results(const Options& of_simulate, const std::string& name) {
  if (is_of_design(name)) return Weight::always;
  const bool is_body_file = name.ends_with("_file") && name != "initial_file";  // by the identities of bodies
  if (!affects_results(name) || is_body_file) return Weight::none;
  return is_of_a_body(of_simulate, name) || of_simulate.is_own(name) ? Weight::of_files : Weight::none;
}

bool is_of_a_drive(const Provenance& provenance) { return provenance.contains("option_drive"); }

std::string command_of(const Options& options, const std::string& verb) {
  std::string text = "elastogear " + verb;
  for (const std::string& file : options.files()) text.append(" ").append(file);
  return text;
}

// "-side coast -torque 300" with what the file was made of.
std::string as_options(const std::vector<InputDifference>& differences) {
  std::string text;
  for (const InputDifference& d : differences) {
    const std::string value = d.there.substr(0, d.there.find(' '));
    if (d.allowed || (value != d.there && !parse<double>(value))) continue;
    text += " -" + d.name + " " + (value == d.there ? value : '"' + d.there + '"');
  }
  return text;
}

// "torque 200 N m for 300 N m": input differences that a comparison has allowed, without the option
// `left_out`.
std::string departures_text(const std::vector<InputDifference>& differences,
                            const std::string& left_out = "") {
  std::string text;
  for (const InputDifference& d : differences)
    if (d.allowed && d.name != left_out)
      text += (text.empty() ? "" : "; ") + d.name + " " + d.there + " for " + d.here;
  return text;
}

// Modes serve equilibria that need none, and meshes have folders of their own.
bool is_chosen_by_run(const std::string& name) {
  constexpr const char* kChosen[] = {"refinement", "modes", "eps_nev", "eps_interval"};
  return std::find(std::begin(kChosen), std::end(kChosen), name) != std::end(kChosen);
}

void require_body(const Options& of_reduce, const DriveMember& member, CommandLines may_depart) {
  const std::string file = body_file(of_reduce, member);
  if (!is_file(file)) return;  // reading it says what is missing
  const Provenance provenance = io::read_provenance(file);
  if (!is_of_a_drive(provenance)) return;
  const auto differences = [&] {
    const Silence silence;
    return input_differences(member_options(of_reduce, member), provenance, [&](const std::string& name) {
      // simulate takes damping of the gear's own section in place of the body's.
      const bool replaced = name.starts_with("damping_") && of_reduce.given(member.name + "_" + name);
      const Weight weight = replaced ? Weight::none : weight_for_bodies(name);
      const bool counts = may_depart == CommandLines::present && !is_chosen_by_run(name);
      return counts && weight == Weight::of_files ? Weight::of_command : weight;
    });
  }();
  const std::string refused = refused_text(differences), departed = departures_text(differences);
  require(refused.empty(), file, ": is not the body of ", member.name, " in this drive: ", refused,
          ". Make it anew by '", command_of(of_reduce, "reduce"),
          "', or give the drive what the body was made of");
  // A command line of reduce that departs from the drive file is not forgotten.
  if (!departed.empty())
    print_item("body " + member.name, "by the command line of reduce " + departed + " of the drive file");
}

// At rest a speed moves nothing but friction, which it is the measure of, and torques win over the files'
// torque.
bool is_idle(const Options& of_simulate, const Provenance& then, const std::string& name) {
  const auto value = [&](const std::string& option) {
    const auto found = then.find("option_" + option);
    return found == then.end() ? std::string() : found->second;
  };
  if (name == "torque")
    return of_simulate.given("torques") && !of_simulate.overrides_files("torque") &&
           !value("torques").empty();
  const bool at_rest = value("analysis") == "sweep" || value("analysis") == "static";
  return name == "speed" && at_rest && parse<double>(value("contact_friction")).value_or(0) == 0 &&
         of_simulate.number("contact_friction") == 0;
}

// Input differences between a result file, or what was recovered of it, and the options in force.
std::vector<InputDifference> differences_of_result(const Options& options, const Provenance& provenance,
                                                   CommandLines may_depart) {
  const Options of_simulate = options.of_verb("simulate", simulate_verb().table);
  const bool present = may_depart == CommandLines::present;
  return input_differences(of_simulate, provenance, [&](const std::string& name) {
    const bool places_flanks = name == "side" && options.verb() == "evaluate";
    if (places_flanks || (present && name == "analysis")) return Weight::always;
    if (is_idle(of_simulate, provenance, name)) return Weight::none;
    const Weight weight = weight_for_results(of_simulate, name);
    return present && weight == Weight::of_files && !is_chosen_by_run(name) ? Weight::of_command : weight;
  });
}

}  // namespace

void require_bodies(const Options& options, const Drive& drive, CommandLines may_depart) {
  const Options of_reduce = options.of_verb("reduce", reduce_verb().table);
  for (const DriveMember& member : drive.members) require_body(of_reduce, member, may_depart);
}

std::string differing_option(const std::string& body, const std::string& other) {
  const auto all = io::read_provenance(body), of_other = io::read_provenance(other);
  const auto differs = [](const Provenance& here, const Provenance& there) -> std::string {
    constexpr const char* kPrefix = "option_";
    for (const auto& [key, value] : here) {
      if (!key.starts_with(kPrefix)) continue;
      const std::string name = key.substr(std::strlen(kPrefix));
      if (weight_for_bodies(name) == Weight::none || is_chosen_by_run(name)) continue;
      const auto found = there.find(key);
      if (found == there.end() || found->second != value) return name;
    }
    return "";
  };
  const std::string name = differs(all, of_other);
  return name.empty() ? differs(of_other, all) : name;
}

void require_input(const Options& options, const std::string& file, CommandLines may_depart) {
  const Provenance provenance = io::read_provenance(file);
  if (!is_of_a_drive(provenance)) return;
  const auto differences = differences_of_result(options, provenance, may_depart);
  const std::string refused = refused_text(differences), given = as_options(differences);
  if (refused.empty()) return;
  if (may_depart == CommandLines::present) fail(file, ": ", refused);
  const auto analysis = provenance.find("option_analysis");
  const bool sweeps =
      analysis != provenance.end() && analysis->second == "sweep" && !options.given("analysis");
  fail(file, ": is not that of the run that this drive describes: ", refused, ". Make it anew by '",
       command_of(options, "simulate"), sweeps ? " -analysis sweep" : "",
       "', after reduce where bodies differ",
       given.empty() ? "" : ", or give " + options.verb() + " the option" + given);
}

void print_departures(const Options& options, const std::vector<std::string>& files) {
  std::set<std::string> said;
  for (const std::string& file : files) {
    const Provenance provenance = io::read_provenance(file);
    if (!is_of_a_drive(provenance)) continue;
    auto differences = differences_of_result(options, provenance, CommandLines::any);
    std::erase_if(differences, [](const InputDifference& d) { return !d.of_command_line; });
    const std::string text = departures_text(differences, "analysis");
    if (!text.empty() && said.insert(text).second)
      print_item("result", "by the command line of simulate " + text + " of the drive file");
  }
}

}  // namespace elastogear::app
