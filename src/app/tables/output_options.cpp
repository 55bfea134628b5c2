#include "app/tables/output_options.h"

#include <filesystem>
#include <sstream>

#include "app/console/console.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/io/csv.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {
namespace {

using dynamics::TimeSettings;

// Words of a file, one a line.
std::vector<std::string> words_of(const std::string& path) {
  std::istringstream in(read_text(path));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

void add_columns(const char* name, const char* unit, const Eigen::MatrixXd& values,
                 std::vector<io::CsvColumn>& columns) {
  constexpr const char* kDirection[] = {" x", " y", " z"};
  for (int d : {0, 1, 2}) columns.push_back({std::string(name) + kDirection[d], unit, values.row(d)});
}

std::string sensor_table(const std::string& output, const std::string& sensor) {
  return std::filesystem::path(output).replace_extension().string() + "_" + sensor + ".csv";
}

// s; empty when none are given. A file of times holds one a line.
std::vector<double> times(const Options& options, const std::string& name) {
  std::vector<std::string> words = options.list(name);
  const bool file = words.size() == 1 && is_file(words[0]);
  const std::string where = "option -" + name + (file ? ", " + words[0] : std::string());
  if (file) words = words_of(words[0]);
  std::vector<double> all;
  for (const std::string& word : words) {
    const std::optional<double> time = parse<double>(word);
    require(time.has_value(), where, ": '", word, "' is neither a time (s) nor a file of times");
    all.push_back(*time);
  }
  return all;
}

const Rows<TimeSettings> kTimeRows = {
    {"output_every", &TimeSettings::output_every, "-", "write every n-th step", kPositive},
    {"output_dt", &TimeSettings::output_dt, "s",
     "write at multiples of this time in place of every n-th step; steps that the run chooses end there, "
     "with "
     "ts_dt a step of its own does"},
    {"output_times", "s", "",
     "write at these times, the start and the end, likewise: t1,t2,... or a file with one a line",
     [](auto& o, auto& name, auto& time) { time.output_times = times(o, name); }},
    {"sensor_csv", "-", "false", "write a CSV table of each sensor beside the result, <output>_<sensor>.csv"},
};

}  // namespace

OptionTable output_table() { return table_of(kTimeRows); }

void set_output_times(const Options& options, TimeSettings& time) { read_rows(options, kTimeRows, time); }

std::vector<std::string> sensor_tables(const Options& options) {
  std::vector<std::string> paths;
  if (!options.flag("sensor_csv")) return paths;
  for (const std::string& sensor : options.placeholder_values("sensors_<sensor>"))
    paths.push_back(sensor_table(options.text("output"), sensor));
  return paths;
}

void write_sensor_tables(const Options& options, const model::ResultHeader& header) {
  if (!options.flag("sensor_csv")) return;
  const std::string output = options.text("output");
  const Eigen::VectorXd time = io::read_times(output);
  const io::TimeAxis axis = io::time_axis(header.input);
  for (const std::string& sensor : header.sensors) {
    const io::SensorHistory history = io::read_sensor_history(output, sensor);
    std::vector<io::CsvColumn> columns = {{axis.name, axis.unit, time}};
    add_columns("position", "m", history.position, columns);
    add_columns("velocity", "m/s", history.velocity, columns);
    add_columns("acceleration", "m/s^2", history.acceleration, columns);
    add_columns("angular velocity", "rad/s", history.angular_velocity, columns);
    const std::string path = sensor_table(output, sensor);
    io::write_csv(path, columns);
    print_item("written", path);
  }
}

}  // namespace elastogear::app
