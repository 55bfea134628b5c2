#include "app/input/master_curve.h"

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <vector>

#include "app/options/units.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"

namespace elastogear::app {
namespace {

struct Column {
  double factor;  // to SI units
  std::vector<double> values = {};
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) {
    const auto first = part.find_first_not_of(" \t\r\""), last = part.find_last_not_of(" \t\r\"");
    parts.push_back(first == part.npos ? "" : part.substr(first, last - first + 1));
  }
  return parts;
}

double factor(const std::string& path, const std::string& name, const std::string& unit) {
  if (name == "frequency") {
    require(unit == "Hz" || unit == "rad/s", path, ": frequency in '", unit, "', must be in Hz or rad/s");
    return unit == "Hz" ? 1 : 1 / (2 * std::numbers::pi);
  }
  const std::string si = name == "time" ? "s" : "Pa";
  const std::optional<double> value = parse<double>(in_unit(path + ": " + name, "1 " + unit, si));
  require(value.has_value(), path, ": '", unit, "' is no unit of ", name);
  return *value;
}

// The heading "name [unit]".
std::pair<std::string, Column> heading(const std::string& path, const std::string& text) {
  const auto open = text.find('['), close = text.find(']');
  require(
      open != text.npos && close != text.npos && open < close, path, ": heading '", text,
      "' lacks its unit; write \"time [s],modulus [MPa]\" or \"frequency [Hz],storage [MPa],loss [MPa]\"");
  std::string name = text.substr(0, open);
  name.erase(name.find_last_not_of(' ') + 1);
  const bool known =
      name == "time" || name == "modulus" || name == "frequency" || name == "storage" || name == "loss";
  return {name, {known ? factor(path, name, text.substr(open + 1, close - open - 1)) : 1}};
}

Eigen::VectorXd values(const std::map<std::string, Column>& columns, const std::string& name) {
  const auto found = columns.find(name);
  if (found == columns.end()) return {};
  const std::vector<double>& v = found->second.values;
  return found->second.factor * Eigen::VectorXd::Map(v.data(), static_cast<Eigen::Index>(v.size()));
}

}  // namespace

model::MasterCurve read_master_curve(const std::string& path) {
  std::ifstream file = open_input(path);
  std::string line;
  require(static_cast<bool>(std::getline(file, line)), path, ": is empty");
  std::vector<std::string> names;
  std::map<std::string, Column> columns;
  for (const std::string& text : split(line)) {
    auto [name, column] = heading(path, text);
    require(columns.emplace(name, column).second, path, ": two columns are named '", name, "'");
    names.push_back(name);
  }
  for (int row = 2; std::getline(file, line); ++row) {
    const std::vector<std::string> parts = split(line);
    if (parts.empty() || (parts.size() == 1 && parts[0].empty())) continue;
    require(parts.size() == names.size(), path, ", line ", row, ": has ", parts.size(),
            " numbers, the heading has ", names.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::optional<double> value = parse<double>(parts[i]);
      require(value && std::isfinite(*value), path, ", line ", row, ": '", parts[i], "' is not a number");
      columns.at(names[i]).values.push_back(*value);
    }
  }
  const bool over_time = columns.contains("time") && columns.contains("modulus");
  require(
      over_time || (columns.contains("frequency") && columns.contains("storage") && columns.contains("loss")),
      path, ": needs the columns time and modulus, or frequency, storage and loss");
  model::MasterCurve curve;
  if (over_time) {
    curve.time = values(columns, "time");
    curve.relaxation = values(columns, "modulus");
  } else {
    curve.frequency = values(columns, "frequency");
    curve.storage = values(columns, "storage");
    curve.loss = values(columns, "loss");
  }
  model::validate(curve, path);
  return curve;
}

}  // namespace elastogear::app
