#pragma once
// The cases of a sweep: one result file, or a folder of them with a table.

#include <string>
#include <utility>
#include <vector>

namespace elastogear::app {

/// One case with what the table says of it beside its name and file.
struct Case {
  std::string name, file;
  std::vector<std::pair<std::string, std::string>> columns = {};  ///< heading and text
};

/// A file is a case of its own name. A folder has a table cases.csv with the columns case and file (relative
/// to the folder); cases with 0 in its column positions, for which the sweep found nothing, are left out.
/// Throws Error naming file and line where the table is wrong.
std::vector<Case> read_cases(const std::string& path);

/// The number that a column holds, such as "torque" or "torque [kN m]", in N m where it is a torque; NaN
/// where it holds none.
double number_in_column(const Case& of, const std::string& heading);

/// N m, size of the torque on the first gear in the run that a file is of; NaN where it does not say it.
double torque_of_run(const std::string& file);

/// Throws Error that begins with `where` when a result file is of a run under another torque (N m).
void require_torque_of_run(const std::string& where, const std::string& file, double torque);

}  // namespace elastogear::app
