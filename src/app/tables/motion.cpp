#include "app/tables/motion.h"

#include <cmath>

#include "app/input/column_table.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"

namespace elastogear::app {
namespace {

double number(const std::string& name, const std::string& text) {
  const std::optional<double> value = parse<double>(text);
  require(value && std::isfinite(*value), "option -", name, ": '", text, "' is not a number");
  return *value;
}

struct Table {
  std::vector<double> time, value;
};

// Two columns of numbers, in SI units, the second in `unit`.
Table read_table(const std::string& path, const std::string& unit, const std::string& unit_of_first = "s") {
  ColumnTable columns(path);
  Table table;
  while (columns.next()) {
    if (columns.n_columns() != 2) columns.fail_here("must be two numbers");
    table.time.push_back(columns.number(0, unit_of_first));
    table.value.push_back(columns.number(1, unit));
  }
  return table;
}

// The file's name is added to what is wrong with its table.
template <class Make>
auto from_table(const std::string& path, const std::string& unit, const Make& make) {
  Table table = read_table(path, unit);
  try {
    return make(std::move(table.time), std::move(table.value));
  } catch (const Error& error) {
    fail(path, ": ", error.what());
  }
}

[[noreturn]] void refuse(const std::string& name, const std::string& allowed) {
  fail("option -", name, ": must be ", allowed);
}

}  // namespace

dynamics::Signal signal(const Options& options, const std::string& name) {
  const std::vector<std::string> words = options.list(name);
  if (words.size() == 1) return dynamics::constant_signal(number(name, words[0]));
  if (words.size() == 3 && words[0] == "ramp")
    return dynamics::ramp_signal(number(name, words[1]), number(name, words[2]));
  if (words.size() == 2 && words[0] == "table")
    return from_table(words[1], options.unit_of(name), dynamics::table_signal);
  refuse(name, "a number, [ramp, VALUE, DURATION] or [table, FILE.csv]");
}

model::DampingRatio damping_ratio(const Options& options, const std::string& name) {
  if (!options.given(name)) return {};
  const std::vector<std::string> words = options.list(name);
  model::DampingRatio damping;
  if (words.size() == 1) {
    damping = {{0}, {number(name, words[0])}};
  } else {
    if (words.size() != 2 || words[0] != "table") refuse(name, "a number or [table, FILE.csv]");
    Table table = read_table(words[1], "-", "Hz");
    require(!table.time.empty(), words[1], ": the table is empty");
    damping = {std::move(table.time), std::move(table.value)};
  }
  validate(damping);
  return damping;
}

dynamics::Drive drive(const Options& options, const std::string& name, double s_0) {
  const std::vector<std::string> words = options.list(name);
  if (words.size() == 2 && words[0] == "speed") return dynamics::speed_drive(s_0, number(name, words[1]));
  if (words.size() == 3 && words[0] == "spin_up")
    return dynamics::spin_up_drive(s_0, number(name, words[1]), number(name, words[2]));
  if (words.size() == 2 && words[0] == "table") {
    return from_table(words[1], options.unit_of(name),
                      [&](std::vector<double> time, std::vector<double> value) {
                        for (double& s : value) s += s_0;
                        return dynamics::table_drive(std::move(time), std::move(value));
                      });
  }
  refuse(name, "[speed, VALUE], [spin_up, VALUE, DURATION] or [table, FILE.csv]");
}

}  // namespace elastogear::app
