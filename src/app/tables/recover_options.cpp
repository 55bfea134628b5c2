#include "app/tables/recover_options.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

std::vector<int> box_levels(const Options& options, const std::string& name) {
  std::vector<int> levels;
  for (const std::string& level : options.list(name)) {
    const bool number =
        !level.empty() && level.size() < 4 && std::all_of(level.begin(), level.end(), isdigit);
    require(number || level == "leaf", "option -", name, " = '", level,
            "': must be a level 0, 1, ... or leaf");
    levels.push_back(number ? std::stoi(level) : std::numeric_limits<int>::max());
  }
  return levels;
}

void read_field_times(const Options& options, const std::string& name, RecoverSettings& settings) {
  settings.all_fields = options.list(name) == std::vector<std::string>{"all"};
  if (!settings.all_fields) settings.field_times = options.numbers(name);
}

int n_directions(const Options& options, const std::string& name) {
  options.choice(name, {"6", "14", "18", "24", "26"});
  return options.count(name);
}

const Rows<RecoverSettings> kRecoverRows = {
    {"result", &RecoverSettings::result, "-", "result file of simulate", kRequired},
    {"output", &RecoverSettings::output, "-", "stress file to write (HDF5); CSV tables are named after it",
     kRequired},
    {"stress_<body>", &RecoverSettings::stress, "-",
     "node sets of a body whose stress histories are wanted (of its stress_nodes)"},
    {"csv", &RecoverSettings::all_nodes, one_of("peak", "all"),
     "nodes in the CSV tables of sets above 10 nodes: peak (those of the largest von Mises and of the "
     "largest principal stress) or all"},
    {"field_times", "s", "",
     "times at which fields of whole bodies are written for ParaView, or all: every output time",
     [](auto& o, auto& name, auto& s) { read_field_times(o, name, s); }},
    {"field_every", &RecoverSettings::field_every, "-",
     "with field_times all: every n-th output time, and the last", kPositive},
    {"fields", &RecoverSettings::fields, "-",
     "first part of the field files' names (default: the result file without .h5)"},
    {"box_levels", "-", "",
     "levels of the bounding-volume trees to write at the first field time: 0, 1, ... or leaf",
     [](auto& o, auto& name, auto& s) { s.box_levels = box_levels(o, name); }},
    {"box_kdop", "-", default_text(RecoverSettings{}.box_kdop), "directions of those bounding volumes",
     [](auto& o, auto& name, auto& s) { s.box_kdop = n_directions(o, name); }},
    {"mode_acceleration", &RecoverSettings::mode_acceleration, one_of("false", "auto", "true"),
     "add what the modes leave out of the response to contact forces, statically: true, false, or auto, for "
     "bodies reduced with -basis modal_residual; true takes a factor of each other body's stiffness matrix, "
     "and so do fields"},
    {"error_estimate", &RecoverSettings::error_estimate, "-",
     "estimate how far stresses are from those of the unreduced body on the same mesh; takes a factor of the "
     "stiffness matrix of bodies without static responses to the contact forces (up to 500,000 "
     "displacements)"},
    {"<body>_file", &RecoverSettings::body_file, "-",
     "body file, when it is no longer where the result file says"},
};

}  // namespace

OptionTable recover_table() { return table_of(kRecoverRows); }

RecoverSettings recover_settings(const Options& options) {
  RecoverSettings settings;
  read_rows(options, kRecoverRows, settings);
  require(settings.all_fields || !options.given("field_every"),
          "option -field_every = ", settings.field_every, ": goes with -field_times all only");
  if (settings.fields.empty())
    settings.fields = std::filesystem::path(settings.result).replace_extension().string();
  return settings;
}

}  // namespace elastogear::app
