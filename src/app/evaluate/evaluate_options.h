#pragma once
// The options of evaluate, beside those of drive files.

#include <map>
#include <string>
#include <vector>

#include "app/options/options.h"
#include "elastogear/drive/drive_result.h"

namespace elastogear::app {

/// What the options ask for.
struct EvaluateSettings {
  std::string result = {}, output = {};   ///< result file or folder of cases; file to write
  std::vector<std::string> coarser = {};  ///< evaluation files of the same cases on coarser meshes
  std::string unloaded = {};              ///< result file of the same positions without load; empty: none
  drive::ReadSettings read = {};
  bool case_tables = true;  ///< CSV tables of every case, beside the table of all cases
  std::map<std::string, std::string> body_file = {};  ///< by body, where the result names another place
};

/// Rows for the options of evaluate.
OptionTable evaluate_table();

EvaluateSettings evaluate_settings(const Options& options);

/// The result of the drive whose path without .h5 is `stem`: the folder of cases where the options sweep over
/// several torques or variants, or where there is no file.
std::string result_of_drive(const Options& options, const std::string& stem);

/// Options with the result and the output of the drive where nothing is given, or as `folder` has them.
Options with_evaluation(Options options, const std::string& folder = "");

}  // namespace elastogear::app
