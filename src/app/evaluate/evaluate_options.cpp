#include "app/evaluate/evaluate_options.h"

#include <filesystem>

#include "app/gear/drive_options.h"
#include "app/options/rows.h"
#include "app/sweep/sweep_cases.h"

namespace elastogear::app {
namespace {

using E = EvaluateSettings;
using R = drive::ReadSettings;

const Rows<E> kEvaluateRows = {
    {"result", &E::result, "-",
     "result file of simulate, or folder of the results of several cases with their cases.csv (default: the "
     "drive's)",
     kDependent},
    {"output", &E::output, "-",
     "evaluation file to write (HDF5); tables (CSV) and the summary (JSON) are named after it (default: the "
     "drive's)",
     kDependent},
    {"coarser", &E::coarser, "-",
     "evaluation files of the same cases on coarser meshes, the coarsest first, for estimated errors by the "
     "mesh of all figures (run sets it)"},
    {"unloaded", &E::unloaded, "-",
     "result file of the same positions under a vanishing torque, for the unloaded transmission error and "
     "the secant stiffness; not needed for exact flanks in place, which have none"},
    {"from", in(&E::read, &R::from), "s",
     "begin of the span of a run in time that is looked at (default: its start)", kDependent},
    {"to", in(&E::read, &R::to), "s", "end of that span (default: its end)", kDependent},
    {"root_stress", in(&E::read, &R::roots), "-", "recover stresses at the roots of the teeth"},
    {"case_tables", &E::case_tables, "-", "of several cases: CSV tables of each, beside the table of all"},
    {"mode_acceleration", in(&E::read, &R::mode_acceleration), one_of("false", "auto", "true"),
     "of stresses at the roots, see recover"},
    {"error_estimate", in(&E::read, &R::error_estimate), "-", "of stresses at the roots, see recover"},
    {"<body>_file", &E::body_file, "-", "body file, when it is no longer where the result file says"},
};

}  // namespace

OptionTable evaluate_table() { return table_of(kEvaluateRows); }

EvaluateSettings evaluate_settings(const Options& options) {
  EvaluateSettings settings;
  read_rows(options, kEvaluateRows, settings);
  return settings;
}

std::string result_of_drive(const Options& options, const std::string& stem) {
  const std::string file = stem + ".h5";
  const bool of_cases = sweeps_torques(options) || options.given("variants");
  const bool several = std::filesystem::is_directory(stem) && (of_cases || !std::filesystem::exists(file));
  return several ? stem : file;
}

Options with_evaluation(Options options, const std::string& folder) {
  const std::string stem = (std::filesystem::path(folder) / drive_stem(options)).string();
  const auto take = [&](const std::string& name, const std::string& value) {
    folder.empty() ? options.set_default(name, value) : options.set(name, value);
  };
  take("result", result_of_drive(options, stem + "_result"));
  take("output", stem + "_evaluation.h5");
  return options;
}

}  // namespace elastogear::app
