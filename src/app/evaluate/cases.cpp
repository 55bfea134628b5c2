#include "app/evaluate/cases.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

#include "app/options/units.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {
namespace {

constexpr const char *kCasesTable = "cases.csv", *kPositions = "positions";

// Texts apart by commas, which within quotes are text.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (char c : line)
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  return cells;
}

// The case of a row; file: relative to the folder.
Case case_of_row(const std::vector<std::string>& heading, const std::vector<std::string>& row,
                 const std::string& folder, const std::string& where) {
  require(row.size() == heading.size(), where, ": has ", row.size(), " cells, the heading has ",
          heading.size());
  Case c;
  for (std::size_t i = 0; i < row.size(); ++i)
    if (heading[i] == "case")
      c.name = row[i];
    else if (heading[i] == "file")
      c.file = (std::filesystem::path(folder) / row[i]).string();
    else
      c.columns.emplace_back(heading[i], row[i]);
  const bool plain = c.name.find_first_of("/\\\"") == std::string::npos;
  require(!c.name.empty() && plain, where, ": '", c.name,
          "' is no name of a case: it must not be empty nor hold slashes or quotes");
  if (number_in_column(c, kPositions) == 0) return c;
  require(is_file(c.file), where, ": there is no file ", c.file);
  return c;
}

std::vector<Case> read_table(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / kCasesTable).string();
  require(is_file(path), folder, ": is a folder without ", kCasesTable,
          ", the table that a sweep of several cases leaves; name a result file");
  std::istringstream in(read_text(path));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> heading = cells_of(line);
  for (const char* needed : {"case", "file"})
    require(std::count(heading.begin(), heading.end(), needed) == 1, path,
            ": its heading must have one column '", needed, "', it is '", line, "'");
  std::vector<Case> cases;
  std::set<std::string> names, files;
  for (int number = 2; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::string where = path + ", line " + std::to_string(number);
    const Case row = case_of_row(heading, cells_of(line), folder, where);
    require(names.insert(row.name).second, where, ": the case ", row.name, " is there twice");
    if (number_in_column(row, kPositions) == 0) continue;
    require_torque_of_run(where, row.file, number_in_column(row, "torque"));
    require(files.insert(row.file).second, where, ": ", row.file, " is the file of another case, too");
    cases.push_back(row);
  }
  require(!cases.empty(), path, ": holds no cases with positions");
  return cases;
}

}  // namespace

std::vector<Case> read_cases(const std::string& path) {
  if (std::filesystem::is_directory(path)) return read_table(path);
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown)) require_file(path);
  require(is_file(path), path,
          ": there is no such result; run 'elastogear simulate' with analysis: sweep, or name it by -result");
  return {{std::filesystem::path(path).stem().string(), path}};
}

double torque_of_run(const std::string& file) {
  const auto input = io::read_run_input(file);
  return input && input->drive ? std::abs(input->drive->torque) : std::numeric_limits<double>::quiet_NaN();
}

void require_torque_of_run(const std::string& where, const std::string& file, double torque) {
  constexpr double kRounding = 1e-9;  // tables have twelve digits
  const double of_run = torque_of_run(file);
  require(!(std::abs(torque - of_run) > kRounding * std::abs(of_run)), where, ": says ", torque, " N m, ",
          file, " is of a run under ", of_run, " N m: put the table right, or sweep again");
}

double number_in_column(const Case& of, const std::string& heading) {
  for (const auto& [name, text] : of.columns)
    if (name == heading || name.starts_with(heading + " [")) {
      const std::string unit = heading_of(of.file, name).unit,
                        number = unit.empty() ? text : std::string(text).append(" ").append(unit);
      if (const auto value = parse<double>(in_unit("column " + name, number, "N m"))) return *value;
    }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastogear::app
