#include "app/evaluate/evaluate_tables.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/console/json_text.h"
#include "elastogear/base/file.h"
#include "elastogear/base/version.h"

namespace elastogear::app {
namespace {

using io::CsvColumn, io::EvaluationItem;
using Items = std::vector<EvaluationItem>;

Eigen::VectorXd column_of(const EvaluationItem& item, std::size_t column = 0) {
  const std::size_t n = item.shape.size() < 2 ? 1 : item.shape[1];
  Eigen::VectorXd values(static_cast<Eigen::Index>(item.shape[0]));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = item.value[static_cast<std::size_t>(i) * n + column];
  return values;
}

void add_curve(std::vector<CsvColumn>& columns, const Items& items, const std::string& path,
               const std::string& name) {
  if (const EvaluationItem* item = find_item(items, path))
    columns.push_back({name, item->unit, column_of(*item)});
}

// One column for each column of a table, with its label behind the name.
void add_columns(std::vector<CsvColumn>& columns, const Items& items, const std::string& path,
                 const std::string& name, const std::vector<std::string>& labels) {
  const EvaluationItem* item = find_item(items, path);
  if (!item) return;
  for (std::size_t c = 0; c < item->shape[1] && c < labels.size(); ++c)
    columns.push_back({name + " " + labels[c], item->unit, column_of(*item, c)});
}

std::string whole(double number) { return std::to_string(static_cast<long>(number)); }

// "3:17" of each pair of teeth.
std::vector<std::string> labels_of_pairs(const Items& items) {
  std::vector<std::string> labels;
  if (const EvaluationItem* teeth = find_item(items, "teeth/tooth"))
    for (std::size_t i = 0; i < teeth->shape[0]; ++i)
      labels.push_back(whole(teeth->value[2 * i]) + ":" + whole(teeth->value[2 * i + 1]));
  return labels;
}

std::vector<std::string> gears_with_roots(const Items& items) {
  std::vector<std::string> gears;
  for (const EvaluationItem& item : items)
    if (item.path.starts_with("root/") && item.path.ends_with("/tooth"))
      gears.push_back(item.path.substr(5, item.path.size() - 5 - 6));
  return gears;
}

std::vector<CsvColumn> over_roll(const Items& items) {
  std::vector<CsvColumn> columns;
  constexpr std::pair<const char*, const char*> kCurves[] = {
      {"roll", "roll angle"},
      {"time", "time"},
      {"transmission_error/loaded", "transmission error"},
      {"transmission_error/unloaded", "unloaded transmission error"},
      {"stiffness/secant", "secant stiffness"},
      {"stiffness/tangent", "tangent stiffness"},
      {"torque/first", "torque on the first gear"},
      {"torque/second", "torque on the second gear"},
      {"force/value", "contact force"},
      {"pressure/largest", "largest pressure"},
      {"pressure/hertz", "largest pressure by Hertz"},
      {"losses/sliding_speed", "sliding speed"},
      {"losses/pv", "pressure times sliding speed"},
      {"losses/friction_power", "friction power"},
      {"teeth/count", "pairs of teeth in contact"}};
  for (const auto& [path, name] : kCurves) add_curve(columns, items, path, name);
  add_columns(columns, items, "teeth/force", "normal force of teeth", labels_of_pairs(items));
  for (const std::string& gear : gears_with_roots(items)) {
    std::vector<std::string> labels;
    for (double tooth : find_item(items, "root/" + gear + "/tooth")->value) labels.push_back(whole(tooth));
    add_columns(columns, items, "root/" + gear + "/tension", "tension at the root of " + gear, labels);
  }
  return columns;
}

std::vector<CsvColumn> of_group(const Items& items, const std::string& group,
                                const std::vector<std::string>& members) {
  std::vector<CsvColumn> columns;
  for (const std::string& member : members)
    add_curve(columns, items, std::string(group).append("/").append(member), member);
  return columns;
}

std::vector<CsvColumn> of_pattern(const Items& items, const std::string& group) {
  std::vector<CsvColumn> columns = of_group(items, group, {"length_of_roll", "radius"});
  std::vector<std::string> labels;
  for (double z : find_item(items, group + "/z")->value) labels.push_back(std::to_string(1e3 * z) + " mm");
  add_columns(columns, items, group + "/pressure", "pressure at z =", labels);
  return columns;
}

// Groups below "pattern/".
std::vector<std::string> patterns_of(const Items& items) {
  std::vector<std::string> groups;
  for (const EvaluationItem& item : items)
    if (item.path.starts_with("pattern/") && item.path.ends_with("/pressure"))
      groups.push_back(item.path.substr(0, item.path.size() - 9));
  return groups;
}

bool is_single(const EvaluationItem& item) { return item.words.empty() && item.shape.empty(); }

std::string plain(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, ' ');
  return text;
}

// Values and words below keys that are the parts of their paths.
nlohmann::ordered_json tree_of(const Items& items) {
  nlohmann::ordered_json tree = nlohmann::ordered_json::object();
  for (const EvaluationItem& item : items) {
    if (!is_single(item) && item.words.empty()) continue;
    nlohmann::ordered_json& at = tree[nlohmann::ordered_json::json_pointer("/" + item.path)];
    if (item.words.size() == 1)
      at = item.words[0];
    else if (!item.words.empty())
      at = item.words;
    else
      at = {{"value", item.value[0]}, {"unit", item.unit}, {"meaning", item.meaning}};
  }
  return tree;
}

nlohmann::ordered_json json_of(const CaseFigures& of) {
  nlohmann::ordered_json j = {{"case", of.of.name}, {"result", of.of.file}};
  for (const auto& [heading, text] : of.of.columns) j["inputs"][heading] = text;
  for (const PairFigures& pair : of.pairs) j["pairs"][pair.pair] = tree_of(pair.items);
  if (!of.bearings.empty()) j.update(tree_of(of.bearings));
  if (!of.notes.empty()) j["notes"] = of.notes;
  return j;
}

}  // namespace

const EvaluationItem* find_item(const Items& items, const std::string& path) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const EvaluationItem& item) { return item.path == path; });
  return found == items.end() ? nullptr : &*found;
}

std::vector<NamedTable> pair_tables(const std::string& stem, const Items& items) {
  std::vector<NamedTable> tables;
  const auto add = [&](const std::string& name, std::vector<CsvColumn> columns) {
    if (!columns.empty()) tables.push_back({stem + name + ".csv", std::move(columns)});
  };
  add("", over_roll(items));
  add("_orders", of_group(items, "transmission_error", {"order", "amplitude", "phase"}));
  add("_force_orders", of_group(items, "force", {"order", "amplitude"}));
  add("_by_pitch",
      of_group(items, "by_pitch",
               {"roll", "speed", "error_mean", "error_peak_to_peak", "force_mean", "force_largest"}));
  add("_line_load", of_group(items, "line_load", {"z", "mean"}));
  for (const std::string& gear : gears_with_roots(items))
    add("_root_" + gear, of_group(items, "root/" + gear + "/way", {"place", "tension", "von_mises"}));
  for (const std::string& group : patterns_of(items)) {
    std::string name = "_" + group;
    std::replace(name.begin(), name.end(), '/', '_');
    add(name, of_pattern(items, group));
  }
  return tables;
}

std::vector<NamedTable> bearing_tables(const std::string& stem, const CaseFigures& of) {
  std::vector<CsvColumn> over_roll, orders;
  if (of.bearings.empty()) return {};
  for (const auto& [path, name] : {std::pair("roll", "roll angle"), std::pair("time", "time")})
    add_curve(over_roll, of.pairs.front().items, path, name);
  for (const EvaluationItem& item : of.bearings) {
    if (item.shape.size() != 1 || !item.words.empty()) continue;
    std::string name = item.path.substr(item.path.find('/') + 1);
    std::replace(name.begin(), name.end(), '/', ' ');
    const bool is_order = item.path.ends_with("/order"), is_amplitude = item.path.ends_with("/amplitude");
    if (is_order && orders.empty()) orders.push_back({"order", item.unit, column_of(item)});
    if (is_amplitude) orders.push_back({name, item.unit, column_of(item)});
    if (!is_order && !is_amplitude && !item.path.ends_with("/phase"))
      over_roll.push_back({name, item.unit, column_of(item)});
  }
  std::vector<NamedTable> tables = {{stem + "_bearings.csv", over_roll}};
  if (!orders.empty()) tables.push_back({stem + "_bearing_orders.csv", orders});
  return tables;
}

void write_cases_table(const std::string& path, const std::vector<CaseFigures>& cases) {
  std::vector<CsvColumn> columns;
  const auto words = [&](const std::string& name, const auto& text) {
    columns.push_back({name, "1", {}, {}});
    for (const CaseFigures& of : cases) columns.back().words.push_back(plain(text(of)));
  };
  words("case", [](const CaseFigures& of) { return of.of.name; });
  words("file", [](const CaseFigures& of) { return of.of.file; });
  for (std::size_t i = 0; i < cases[0].of.columns.size(); ++i)
    words(plain(cases[0].of.columns[i].first),
          [&](const CaseFigures& of) { return of.of.columns[i].second; });
  for (std::size_t p = 0; p < cases[0].pairs.size(); ++p)
    for (const EvaluationItem& item : cases[0].pairs[p].items) {
      if (!is_single(item)) continue;
      Eigen::VectorXd values(static_cast<Eigen::Index>(cases.size()));
      bool all = true;
      for (std::size_t c = 0; c < cases.size() && all; ++c) {
        const EvaluationItem* of_case =
            p < cases[c].pairs.size() ? find_item(cases[c].pairs[p].items, item.path) : nullptr;
        if (of_case) values[static_cast<Eigen::Index>(c)] = of_case->value[0];
        all = of_case != nullptr;
      }
      if (all) columns.push_back({cases[0].pairs[p].pair + " " + item.path, item.unit, values});
    }
  io::write_csv(path, columns);
}

void write_summary(const std::string& path, const std::string& drive, const std::vector<CaseFigures>& cases) {
  nlohmann::ordered_json j = {
      {"format", "elastogear evaluation summary"}, {"version", 1}, {"program", version()}, {"drive", drive}};
  j["cases"] = nlohmann::ordered_json::array();
  for (const CaseFigures& of : cases) j["cases"].push_back(json_of(of));
  write_file(path, json_text(j));
}

}  // namespace elastogear::app
