#include "app/sweep/sweep_cases.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <optional>
#include <set>
#include <sstream>

#include "app/gear/bearing_options.h"
#include "app/gear/drive_options.h"
#include "app/gear/misalignment.h"
#include "app/gear/modification_options.h"
#include "app/options/rows.h"
#include "app/options/spelling.h"
#include "app/options/units.h"
#include "app/tables/contact_options.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

constexpr int kMostCases = 1000000;

struct CaseChoices {
  std::vector<double> torques = {};
  std::vector<std::string> variants = {};
};

const Rows<CaseChoices> kCaseRows = {
    {"torques", &CaseChoices::torques, "N m", "sweep: in place of a file's torque, one case each",
     kDependent},
    {"variants", &CaseChoices::variants, "-",
     "sweep: names of variants of the drive, or a CSV file (.csv) with one a line below a line of keys; one "
     "case each, with every torque",
     kDependent},
    {"variant_<variant>", "-", "",
     "sweep: what a variant has in place of the drive's: keys of micro-geometry, misalignment, bearings and "
     "contact, as in 'variant_crowned: {pinion: {lead_crowning: 10 um}}'"},
};

// A key of a variant: its full name, as errors give it, the option that it sets, and the value that a user
// wrote.
struct Entry {
  std::string label, key, value;
};

// Options that change neither meshes nor bodies, with the names of the gears and of their bearings.
OptionTable variant_keys(const Options& options) {
  PlaceholderValues names = {{"gear", options.list("gears")}, {"bearing", {}}};
  for (const std::string& gear : names["gear"])
    for (const std::string& bearing : options.list(gear + "_bearings")) names["bearing"].push_back(bearing);
  OptionTable all;
  for (const OptionTable& table :
       {modification_table(), misalignment_table(), bearing_table(), contact_table()})
    for (const OptionSpec& spec : expand(table, names))
      if (spec.name != "contact_pairs" && spec.name != "contact_surface") all.push_back(spec);
  return all;
}

const OptionSpec& spec_of(const OptionTable& keys, const Entry& entry) {
  const OptionSpec* nearest = &keys.front();
  for (const OptionSpec& spec : keys) {
    if (spec.name == entry.key) return spec;
    if (misspelling(entry.key, spec.name) < misspelling(entry.key, nearest->name)) nearest = &spec;
  }
  fail(entry.label, ": '", entry.key, "' is no key that a variant may have (micro-geometry, misalignment, ",
       "bearings, contact); the nearest one is ", nearest->name);
}

void add(const OptionTable& keys, const Entry& entry, Variant& variant) {
  const OptionSpec& spec = spec_of(keys, entry);
  variant.keys.push_back({entry.key, in_unit(entry.label, entry.value, spec.unit), spec.unit});
}

// Fields apart by commas, with blanks and quotes around them taken off; within quotes commas are text.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (char c : line)
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else if (c != '\r')
      fields.back() += c;
  for (std::string& field : fields) {
    const auto first = field.find_first_not_of(" \t"), last = field.find_last_not_of(" \t");
    field = first == field.npos ? "" : field.substr(first, last - first + 1);
  }
  return fields;
}

std::string padded(std::size_t number) {
  char text[32];
  std::snprintf(text, sizeof text, "%04zu", number);
  return text;
}

// The keys of a table's columns with their units.
std::vector<Heading> heading_of_table(const std::string& where, const std::vector<std::string>& fields,
                                      const OptionTable& keys) {
  std::vector<Heading> head;
  for (const std::string& field : fields) {
    const Heading heading = heading_of(where, field);
    if (heading.name != "variant") spec_of(keys, {where, heading.name, ""});
    for (const Heading& earlier : head)
      require(earlier.name != heading.name, where, ": the key ", heading.name, " stands there twice");
    head.push_back(heading);
  }
  return head;
}

// A column `variant` holds the names, which else are numbers; an empty field leaves the drive's value.
std::vector<Variant> variants_of_table(const std::string& file, const OptionTable& keys) {
  std::istringstream in(read_text(file));
  std::vector<Heading> head;
  std::vector<Variant> variants;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    const std::string where = file + ", line " + std::to_string(line);
    const std::vector<std::string> fields = fields_of(text);
    if (fields.size() == 1 && fields[0].empty()) continue;
    if (fields[0].starts_with('#')) continue;
    require(is_utf8(text), where, ": has letters that are not in UTF-8; save the file as UTF-8");
    if (head.empty()) {
      head = heading_of_table(where, fields, keys);
      continue;
    }
    require(fields.size() == head.size(), where, ": has ", fields.size(), " fields, the line of keys has ",
            head.size());
    Variant variant{padded(variants.size() + 1)};
    for (std::size_t i = 0; i < head.size(); ++i)
      if (head[i].name == "variant")
        variant.name = fields[i];
      else if (!fields[i].empty())
        add(keys, {where, head[i].name, head[i].unit.empty() ? fields[i] : fields[i] + " " + head[i].unit},
            variant);
    variants.push_back(variant);
  }
  require(!variants.empty(), file, ": holds no variants: a line of keys, and one line for each variant");
  return variants;
}

std::vector<Variant> variants_by_name(const Options& options, const std::vector<std::string>& names,
                                      const OptionTable& keys) {
  std::vector<Variant> variants;
  for (const std::string& name : names) variants.push_back({name});
  for (const std::string& word : options.placeholder_values("variant_<variant>")) {
    const std::string option = "variant_" + word;
    Variant* owner = nullptr;  // that with the longest name: one may begin with another one's
    for (Variant& variant : variants)
      if (word.starts_with(variant.name + "_") && (!owner || variant.name.size() > owner->name.size()))
        owner = &variant;
    require(owner, options.label(option), ": belongs to none of -variants ", join(names));
    add(keys, {options.label(option), word.substr(owner->name.size() + 1), options.text(option)}, *owner);
  }
  return variants;
}

std::vector<Variant> read_variants(const Options& options, const std::vector<std::string>& names) {
  const OptionTable keys = variant_keys(options);
  const bool table = names.size() == 1 && names[0].ends_with(".csv");
  std::vector<Variant> variants =
      table ? variants_of_table(names[0], keys) : variants_by_name(options, names, keys);
  std::set<std::string> seen;
  for (const Variant& variant : variants)
    require(seen.insert(variant.name).second, table ? names[0] : options.label("variants"), ": the variant '",
            variant.name, "' is there twice");
  if (variants.empty()) variants.emplace_back();
  return variants;
}

std::string digits_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

// A number in the digits that a user would write; of lists the text, within quotes.
std::string table_text(const std::string& text) {
  const std::optional<double> number = parse<double>(text);
  if (!number) return text.find(',') == text.npos ? text : '"' + text + '"';
  std::ostringstream out;
  out << std::setprecision(12) << *number;
  return out.str();
}

}  // namespace

OptionTable case_table() { return table_of(kCaseRows); }

bool sweeps_torques(const Options& options) {
  if (!options.given("torques")) return false;
  if (!options.given("torque") || !options.overrides_files("torque")) return true;
  require(!options.overrides_files("torques"), options.label("torques"), ": and ", options.label("torque"),
          ": give one of them");
  return false;
}

SweepCases sweep_cases(const Options& options) {
  CaseChoices choices;
  read_rows(options, kCaseRows, choices);
  const bool of_torques = sweeps_torques(options);
  if (!of_torques) choices.torques.clear();
  for (double torque : choices.torques) require_torque_of_side(options, "torques", torque);
  SweepCases all;
  all.variants = read_variants(options, choices.variants);
  all.several = of_torques || options.given("variants");
  if (choices.torques.empty()) choices.torques.push_back(options.number("torque"));
  const double n = static_cast<double>(choices.torques.size()) * static_cast<double>(all.variants.size());
  require(n <= kMostCases, "a sweep of ", n, " cases: must be at most ", kMostCases);
  for (std::size_t v = 0; v < all.variants.size(); ++v)
    for (double torque : choices.torques) all.cases.push_back({torque, static_cast<int>(v)});
  return all;
}

Options of_case(const Options& options, const SweepCases& all, const SweepCase& one) {
  Options own = options;
  if (sweeps_torques(options)) own.set("torque", digits_of(one.torque));
  for (const Variant::Key& key : all.variants[static_cast<std::size_t>(one.variant)].keys)
    own.set(key.name, key.value);
  return own;
}

void write_case_table(const std::string& path, const SweepCases& all, const std::vector<std::string>& files,
                      const std::vector<int>& found) {
  std::vector<Variant::Key> keys;
  const auto is = [](const std::string& name) {
    return [&name](const Variant::Key& key) { return key.name == name; };
  };
  for (const Variant& variant : all.variants)
    for (const Variant::Key& key : variant.keys)
      if (std::none_of(keys.begin(), keys.end(), is(key.name))) keys.push_back(key);
  std::ostringstream out;
  out << "case,file,torque [N m],variant,positions";
  for (const Variant::Key& key : keys)
    out << ',' << key.name << (key.unit == "-" ? "" : " [" + key.unit + "]");
  for (std::size_t i = 0; i < all.cases.size(); ++i) {
    const Variant& variant = all.variants[static_cast<std::size_t>(all.cases[i].variant)];
    out << '\n'
        << i + 1 << ',' << files[i] << ',' << table_text(digits_of(all.cases[i].torque)) << ','
        << variant.name << ',' << found[i];
    for (const Variant::Key& key : keys) {
      const auto own = std::find_if(variant.keys.begin(), variant.keys.end(), is(key.name));
      out << ',' << (own == variant.keys.end() ? "" : table_text(own->value));
    }
  }
  out << '\n';
  write_file(path, out.str());
}

}  // namespace elastogear::app
