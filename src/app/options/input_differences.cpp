#include "app/options/input_differences.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "elastogear/base/file.h"
#include "elastogear/base/fingerprint.h"
#include "elastogear/base/number.h"

namespace elastogear::app {
namespace {

using Entries = std::map<std::string, std::string>;

constexpr std::string_view kOptionKey = "option_", kInFilesKey = "in_files_",
                           kCommandLineKey = "command_line_", kNotGiven = "not given";

// Items of a list, without the brackets and blanks around them.
std::vector<std::string> items_of(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream in(text);
  for (std::string item; std::getline(in, item, ',');) {
    const auto first = item.find_first_not_of(" []"), last = item.find_last_not_of(" []");
    if (first != item.npos) items.push_back(item.substr(first, last - first + 1));
  }
  return items;
}

// 0.9 cm and 9 mm are the same up to roundoff.
bool same_item(const std::string& a, const std::string& b) {
  constexpr double kRoundoff = 1e-14;
  const auto x = parse<double>(a), y = parse<double>(b);
  return x && y ? std::abs(*x - *y) <= kRoundoff * std::abs(*x) : a == b;
}

bool same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const std::vector<std::string> x = items_of(a), y = items_of(b);
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), same_item);
}

// An option as it was in force, and as the files had it.
struct Said {
  std::string value, in_files;
};

Said said(const Entries& entries, const std::string& name, const std::string& default_value) {
  const auto value_of = [&](std::string_view key, const std::string& otherwise) {
    const auto found = entries.find(std::string(key) + name);
    if (found == entries.end()) return otherwise;
    return found->second.empty() ? default_value : found->second;
  };
  Said both;
  both.value = value_of(kOptionKey, default_value);
  both.in_files = value_of(kInFilesKey, both.value);
  return both;
}

std::string with_own_unit(const Options& options, const std::string& name, const std::string& value) {
  const std::string unit = options.unit_of(name);
  if (value.empty()) return std::string(kNotGiven);
  const auto number = parse<double>(value);
  if (!number) return value;
  std::ostringstream text;
  text.precision(12);
  text << *number;
  return text.str() + (unit.empty() || unit == "-" ? "" : " " + unit);
}

// Programs before this comparison did not write what files say.
bool tells_files(const Entries& then) {
  const auto first = then.lower_bound(std::string(kInFilesKey));
  return first != then.end() && first->first.starts_with(kInFilesKey);
}

// Files that the options in force name and whose contents have changed.
void add_changed_files(const Entries& now, const Entries& then, std::vector<InputDifference>& all) {
  std::set<std::string> seen;
  for (const auto& [key, value] : now) {
    if (!key.starts_with(kOptionKey)) continue;
    for (const std::string& file : items_of(value)) {
      const auto found = then.find(fingerprint_key(file));
      if (found == then.end() || !seen.insert(file).second || !is_file(file)) continue;
      const std::string here = file_fingerprint(file);
      if (here == found->second) continue;
      all.push_back({key.substr(kOptionKey.size()), file + " before it changed", file + " as it is"});
    }
  }
}

}  // namespace

std::vector<InputDifference> input_differences(const Options& now, const Entries& then,
                                               const std::function<Weight(const std::string&)>& weight) {
  const Entries mine = now.provenance();
  std::set<std::string> names;
  for (const Entries* entries : {&mine, &then})
    for (const auto& [key, value] : *entries)
      if (key.starts_with(kOptionKey)) names.insert(key.substr(kOptionKey.size()));
  std::vector<InputDifference> all;
  for (const std::string& name : names) {
    const Weight of = weight(name);
    if (of == Weight::none || (of != Weight::always && !tells_files(then))) continue;
    const std::string otherwise = now.default_of(name);
    const Said here = said(mine, name, otherwise), there = said(then, name, otherwise);
    if (same_value(here.value, there.value)) continue;
    const bool of_command_line = then.contains(std::string(kCommandLineKey) + name),
               may_depart = of == Weight::of_files || (of == Weight::of_command && !of_command_line),
               allowed =
                   may_depart && !now.overrides_files(name) && same_value(here.in_files, there.in_files);
    all.push_back({name, with_own_unit(now, name, there.value), with_own_unit(now, name, here.value), allowed,
                   of_command_line});
  }
  add_changed_files(mine, then, all);
  return all;
}

std::string refused_text(const std::vector<InputDifference>& differences) {
  std::string text;
  for (const InputDifference& d : differences)
    if (!d.allowed)
      text += (text.empty() ? "" : "; ") + d.name + ": " + d.there + " there, " + d.here + " here";
  return text;
}

std::string file_fingerprint(const std::string& file) {
  Fingerprint f;
  f.add(read_file(file));
  return f.text();
}

}  // namespace elastogear::app
