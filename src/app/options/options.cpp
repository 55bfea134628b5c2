#include "app/options/options.h"

#include <slepcsys.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "app/options/command_line.h"
#include "app/options/options_file.h"
#include "app/options/petsc_names.h"
#include "app/options/spelling.h"
#include "app/options/units.h"
#include "app/options/yaml.h"
#include "elastogear/base/broadcast.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/text.h"
#include "elastogear/base/version.h"

namespace elastogear::app {
namespace {

// Commas between double quotes belong to an item, "FIX, LEFT":x; a quote without a second one is a letter.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    std::size_t end = begin;
    for (bool quoted = false; end < text.size() && (quoted || text[end] != ','); ++end)
      if (text[end] == '"') quoted = !quoted && text.find('"', end + 1) != text.npos;
    std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    const auto first = part.find_first_not_of(" []"), last = part.find_last_not_of(" []");
    if (first == std::string::npos) continue;
    part = part.substr(first, last - first + 1);
    if (std::count(part.begin(), part.end(), '"') % 2 == 0) std::erase(part, '"');
    if (!part.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

double parse_number(const std::string& label, const std::string& text, const std::string& unit) {
  const std::optional<double> value = parse<double>(text);
  require(value && std::isfinite(*value), label, " = '", text, "': must be a finite number (", unit, ")");
  return *value;
}

std::map<std::string, std::string> options_in_database() {
  // Nothing has been queried yet, so that the unused options are all options.
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &n, &names, &values));
  std::map<std::string, std::string> options;
  for (PetscInt i = 0; i < n; ++i) options[names[i]] = values[i] ? values[i] : "";
  check(PetscOptionsLeftRestore(nullptr, &n, &names, &values));
  return options;
}

// How much of a name a key says beside its placeholder: "variant_<variant>" says more of
// "variant_soft_left_radial" than "<bearing>_radial".
std::size_t letters_of(const OptionSpec& spec) {
  const auto open = spec.name.find('<');
  return open == spec.name.npos ? spec.name.size() : spec.name.size() - (spec.name.find('>') - open + 1);
}

// PETSc takes values of these for kinds of viewers or files, also the true and false of a file of keys.
bool names_viewer(const std::string& name) {
  return name.find("monitor") != name.npos || name.ends_with("_view") || name.ends_with("_reason");
}

// Options by the names of earlier versions.
const std::map<std::string, std::string> kRenamed = {
    {"contact_crease", "contact_feature_angle"},
    {"contact_smooth", "contact_surface: facets, smooth or exact"}};

// "-modes (number of modes)"; of equally near ones the running verb's come first, then those of others, then
// PETSc's. in_file: where PETSc's options are rare, only those that begin as the name does are meant.
std::string nearest_option(const std::string& name, const OptionTable& own, const OptionTable& known,
                           bool in_file) {
  const OptionSpec* best = nullptr;
  for (const OptionTable* table : {&own, &known})
    for (const OptionSpec& spec : *table)
      if (!best || misspelling(name, spec.name) < misspelling(name, best->name)) best = &spec;
  const std::string prefix = name.starts_with("elastic_") ? "elastic_" : "",
                    object = name.substr(0, name.find('_') + 1);
  std::string petsc;
  for (const std::string& word : petsc_names()) {
    if (in_file && (object.empty() || !(prefix + word).starts_with(object))) continue;
    if (petsc.empty() || misspelling(name, prefix + word) < misspelling(name, petsc)) petsc = prefix + word;
  }
  if (!best || (!petsc.empty() && misspelling(name, petsc).edits < misspelling(name, best->name).edits))
    return "-" + petsc + " (PETSc's or SLEPc's)";
  return "-" + best->name + (best->help.empty() ? "" : " (" + best->help + ")");
}

std::string text_on_all_ranks(const std::string& file) {
  std::vector<char> text;
  collectively(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank != 0) return;
    const std::string content = read_file(file);
    text.assign(content.begin(), content.end());
  });
  broadcast(PETSC_COMM_WORLD, text);
  return {text.begin(), text.end()};
}

}  // namespace

Options::Options(std::string verb, OptionTable own, OptionTable known)
    : verb_(std::move(verb)), own_(std::move(own)), known_(std::move(known)) {}

Options Options::of_files(std::string verb, const OptionTable& own, const std::vector<std::string>& files) {
  Options options(std::move(verb), own, own);
  const std::string section = options.verb_ + "_";
  for (const bool of_section : {false, true})  // the verb's own section wins
    for (const std::string& file : files)
      for (const YamlEntry& entry : parse_yaml(read_file(file), file)) {
        if (entry.name.starts_with(section) != of_section) continue;
        const std::string name = of_section ? entry.name.substr(section.size()) : entry.name;
        options.given_[name] = entry.value;
        options.place_[name] = file + ", line " + std::to_string(entry.line);
      }
  options.files_ = files;
  options.convert_units();
  return options;
}

void Options::insert(const std::string& text, const std::string& name, Source source) {
  for (const YamlEntry& entry : parse_yaml(text, name)) {
    given_[entry.name] = entry.value;
    bare_.erase(entry.name);
    place_.erase(entry.name);
    if (source == Source::file) place_[entry.name] = name + ", line " + std::to_string(entry.line);
    if (source != Source::chosen) written_[entry.name] = entry.value;
  }
}

void Options::promote_own_section() {
  const std::string section = verb_ + "_";
  const std::map<std::string, std::string> all = given_;
  for (const auto& [name, value] : all)
    if (name.starts_with(section)) {
      const std::string own = name.substr(section.size());
      given_.erase(name);
      given_[own] = value;
      promoted_.insert(own);
      if (bare_.contains(name)) bare_.insert(own);
      if (place_.contains(name)) place_[own] = place_[name];
      if (written_.contains(name)) written_[own] = written_[name];
    }
}

// of_environment: what PETSc has read from there and from its own files. The words follow each other as they
// were written.
void Options::insert_command_line(const std::map<std::string, std::string>& of_environment, int argc,
                                  char** argv) {
  for (const auto& [name, value] : of_environment) {
    given_[name] = value;
    if (value.empty()) bare_.insert(name);
  }
  for (const GivenOption& option : given_options(argc, argv)) {
    given_[option.name] = option.value;
    bare_.erase(option.name);
    if (option.value.empty()) bare_.insert(option.name);
    place_.erase(option.name);
    if (!option.place.empty()) place_[option.name] = option.place;
  }
}

void Options::note_options_files(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i)
    if (argv[i][0] == '-' && names_options_file({argv[i] + 1, argv[i + 1]}))
      files_.push_back(path_of_options_file(argv[i + 1]));
}

// Not all of them: its database holds 512. A viewer that is on is given by its name alone.
void Options::give_to_petsc() const {
  for (const auto& [name, value] : given_) {
    if (!is_petsc_name(name)) continue;
    const bool viewer = names_viewer(name);
    if (viewer && value == "false") {
      check(PetscOptionsClearValue(nullptr, ("-" + name).c_str()));  // at its start PETSc has read it
      continue;
    }
    const bool bare = value.empty() || (viewer && value == "true");
    check(PetscOptionsSetValue(nullptr, ("-" + name).c_str(), bare ? nullptr : value.c_str()));
    // Our own keys count as used; PETSc's are checked after the run.
    if (has(known_, name)) check(PetscOptionsHasName(nullptr, nullptr, ("-" + name).c_str(), nullptr));
  }
}

std::string Options::in_own_unit(const std::string& name, const std::string& value) const {
  const std::string unit = unit_of(name);
  return unit.empty() ? value : in_unit(label(name), value, unit);
}

std::string Options::unit_of(const std::string& name) const {
  const OptionSpec *own = find_spec(own_, name), *known = find_spec(known_, name);
  const bool of_other = !own || (known && letters_of(*known) > letters_of(*own));
  const OptionSpec* spec = of_other ? known : own;
  return spec ? spec->unit : "";
}

void Options::convert_units() {
  for (auto& [name, value] : given_) {
    const std::string converted = in_own_unit(name, value);
    if (converted != value) with_unit_.insert(name);
    value = converted;
  }
}

// The command line and what a program chooses win over files, which say something else.
void Options::note_overrides() {
  for (const auto& [name, value] : given_) {
    const auto written = written_.find(name);
    const std::string in_files = written == written_.end() ? "" : in_own_unit(name, written->second);
    if (written != written_.end() && in_files == value) continue;
    in_files_[name] = in_files;
    on_command_line_.insert(name);
  }
}

void Options::load(const OptionSources& sources) {
  int n_words = 1;  // PETSc's own files and the environment alone
  char** argv = sources.argv;
  check(PetscOptionsInsert(nullptr, &n_words, &argv, nullptr));
  const std::map<std::string, std::string> of_environment = options_in_database();
  insert_command_line(of_environment, sources.argc, sources.argv);  // keys of the verb's section among them
  for (const std::string& file : sources.files) {
    insert(text_on_all_ranks(file), file, Source::file);
    files_.push_back(file);
  }
  for (const OptionText& text : sources.texts) {
    insert(text.yaml, text.name, Source::text);
    files_.push_back(text.name);
  }
  promote_own_section();
  given_in_files_ = given_;
  insert_command_line(of_environment, sources.argc, sources.argv);
  note_options_files(sources.argc, sources.argv);
  for (const OptionText& text : sources.chosen) insert(text.yaml, text.name, Source::chosen);
  for (const auto& [name, value] : given_) {
    const auto equals = name.find('=');
    require(equals == name.npos, label(name), ": write the name and its value as two words, -",
            name.substr(0, equals), " ", equals == name.npos ? "" : name.substr(equals + 1));
  }
  convert_units();
  note_overrides();
  give_to_petsc();
}

void Options::reject_unknown(const PlaceholderValues& given_values) const {
  PlaceholderValues values = given_values;
  values.try_emplace("gear", given("drive") ? list_with_files("gears") : std::vector<std::string>{});
  std::vector<std::string>& bearings = values["bearing"];
  for (const std::string& gear : values["gear"])
    for (const std::string& name : list_with_files(gear + "_bearings")) bearings.push_back(name);
  const OptionTable known = expand(known_, values);
  for (const auto& [name, value] : given_) {
    if (has(known, name)) continue;
    if (const auto renamed = kRenamed.find(name); renamed != kRenamed.end())
      fail(label(name), " is now called -", renamed->second);
    if (is_petsc_name(name)) {
      check_petsc_type(label(name), name, value);
      check_petsc_limits(label(name), name, value);
      continue;
    }
    fail("unknown ", label(name), value.empty() ? "" : " = '" + value + "'", "; the nearest known option is ",
         nearest_option(name, expand(own_, values), known, written_.contains(name)), ". 'elastogear ", verb_,
         " -help all' lists all.");
  }
}

std::string Options::label(const std::string& name) const {
  const auto place = place_.find(name);
  return "option -" + name + (place == place_.end() ? "" : " (" + place->second + ")");
}

std::map<std::string, std::string> Options::given_to_verb() const {
  std::map<std::string, std::string> own;
  for (const auto& [name, value] : given_)
    if (has(own_, name)) own[name] = value;
  return own;
}

const OptionSpec& Options::spec(const std::string& name) const {
  const OptionSpec* found = find_spec(own_, name);
  require(found, "internal: option -", name, " is in no table of verb ", verb_);
  return *found;
}

bool Options::given(const std::string& name) const { return given_.contains(name); }

std::string Options::text(const std::string& name) const {
  const auto found = given_.find(name);
  const std::string value = found != given_.end() ? found->second : spec(name).default_value;
  require(!value.empty(), label(name), " is missing: ", spec(name).help);
  return value;
}

double Options::number(const std::string& name) const {
  return parse_number(label(name), text(name), spec(name).unit);
}

double Options::positive(const std::string& name) const {
  const double value = number(name);
  require(value > 0, label(name), " = ", value, " ", spec(name).unit, ": must be positive");
  return value;
}

int Options::count(const std::string& name, int smallest) const {
  const std::string value = text(name);
  const std::optional<int> number = parse<int>(value);
  require(number && *number >= smallest, label(name), " = '", value, "': must be a whole number of at least ",
          smallest);
  return *number;
}

bool Options::flag(const std::string& name) const {
  if (bare_.contains(name) && given(name) && given_.at(name).empty()) return true;
  require(!given(name) || !given_.at(name).empty(), label(name), ": is empty, write true or false");
  return choice(name, {"false", "true", "no", "yes", "0", "1"}) % 2 == 1;
}

Eigen::Vector3d Options::vector(const std::string& name) const {
  const std::vector<double> values = numbers(name);
  require(values.size() == 3, label(name), " = '", text(name), "': must be three numbers x,y,z (",
          spec(name).unit, ")");
  return {values[0], values[1], values[2]};
}

std::vector<double> Options::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const std::string& part : list(name))
    values.push_back(parse_number(label(name), part, spec(name).unit));
  return values;
}

std::vector<std::string> Options::list(const std::string& name) const {
  const auto found = given_.find(name);
  return split(found != given_.end() ? found->second : spec(name).default_value);
}

std::vector<std::string> Options::list_with_files(const std::string& name) const {
  std::vector<std::string> all;
  for (const auto* given : {&given_, &given_in_files_}) {
    const auto found = given->find(name);
    if (found == given->end()) continue;
    for (const std::string& part : split(found->second))
      if (std::find(all.begin(), all.end(), part) == all.end()) all.push_back(part);
  }
  return all;
}

bool Options::has_key(const std::string& pattern) const {
  return std::any_of(known_.begin(), known_.end(),
                     [&](const OptionSpec& spec) { return spec.name == pattern; });
}

bool Options::begins_key(const std::string& word) const {
  return std::any_of(known_.begin(), known_.end(),
                     [&](const OptionSpec& spec) { return spec.name.starts_with(word + "_"); });
}

bool Options::is_of_other_verb(const std::string& name) const {
  return !has(own_, name) && has(known_, name);
}

Options Options::of_section(const std::string& section, const std::vector<std::string>& excluded) const {
  Options options = *this;
  for (const auto& [name, value] : given_) {
    if (!name.starts_with(section + "_")) continue;
    const std::string own = name.substr(section.size() + 1);
    if (!has(own_, own) || std::find(excluded.begin(), excluded.end(), own) != excluded.end()) continue;
    options.take(own, *this, name, value);
  }
  return options;
}

// The value of another option, with where it comes from.
void Options::take(const std::string& own, const Options& from, const std::string& name,
                   const std::string& value) {
  given_[own] = value;
  from.bare_.contains(name) ? void(bare_.insert(own)) : void(bare_.erase(own));
  from.with_unit_.contains(name) ? void(with_unit_.insert(own)) : void(with_unit_.erase(own));
  place_.erase(own);
  in_files_.erase(own);
  by_default_.erase(own);
  from.on_command_line_.contains(name) ? void(on_command_line_.insert(own))
                                       : void(on_command_line_.erase(own));
  if (const auto place = from.place_.find(name); place != from.place_.end()) place_[own] = place->second;
  if (const auto other = from.in_files_.find(name); other != from.in_files_.end())
    in_files_[own] = other->second;
}

// What the command line gives without the section wins over the files' section.
Options Options::of_verb(const std::string& verb, const OptionTable& own) const {
  Options options = *this;
  options.verb_ = verb;
  options.own_ = own;
  for (const auto& [name, value] : given_) {
    if (!name.starts_with(verb + "_")) continue;
    const std::string bare = name.substr(verb.size() + 1);
    if (has(own, bare) && !overrides_files(bare))
      options.take(bare, *this, name, options.in_own_unit(bare, value));
  }
  return options;
}

void Options::set(const std::string& name, const std::string& value) {
  in_files_.try_emplace(name, given(name) ? given_[name] : "");
  by_default_.erase(name);
  given_[name] = value;
  place_.erase(name);
}

void Options::set_default(const std::string& name, const std::string& value) {
  if (!given_.try_emplace(name, value).second) return;
  in_files_[name].clear();
  by_default_.insert(name);
}

void Options::append(const std::string& name, const std::string& word) {
  in_files_.try_emplace(name, given(name) ? given_[name] : "");
  std::string& words = given_[name];
  words += (words.empty() ? "" : ",") + word;
}

bool Options::overrides_files(const std::string& name) const {
  return in_files_.contains(name) && !by_default_.contains(name);
}

std::string Options::default_of(const std::string& name) const {
  const OptionSpec* found = find_spec(own_, name);
  return found ? found->default_value : "";
}

int Options::choice(const std::string& name, const std::vector<std::string>& allowed) const {
  const std::string value = text(name);
  const auto found = std::find(allowed.begin(), allowed.end(), value);
  require(found != allowed.end(), label(name), " = '", value, "': must be one of ", join(allowed));
  return static_cast<int>(found - allowed.begin());
}

std::vector<std::string> Options::placeholder_values(const std::string& pattern) const {
  std::vector<std::string> values;
  const auto is_of_another = [&](const std::string& name) {
    const auto is_it = [&](const OptionSpec& spec) { return spec.name == name; };
    return std::any_of(known_.begin(), known_.end(), is_it) && !promoted_.contains(name) &&
           std::none_of(own_.begin(), own_.end(), is_it);
  };
  for (const auto& [name, value] : given_)
    if (const auto word = placeholder(pattern, name); word && !is_of_another(name)) values.push_back(*word);
  return values;
}

std::map<std::string, std::string> Options::provenance() const {
  std::map<std::string, std::string> all;
  for (const OptionSpec& s : own_)
    if (s.name.find('<') == std::string::npos && !s.default_value.empty())
      all["option_" + s.name] = s.default_value;
  for (const auto& [name, value] : given_) all["option_" + name] = value;
  for (const auto& [name, value] : in_files_) all["in_files_" + name] = value;
  for (const std::string& name : on_command_line_) all["command_line_" + name] = given_.at(name);
  char petsc[256], slepc[256];
  check(PetscGetVersion(petsc, sizeof petsc));
  check(SlepcGetVersion(slepc, sizeof slepc));
  all["program_version"] = version();
  all["git_hash"] = git_hash();
  all["petsc_version"] = petsc;
  all["slepc_version"] = slepc;
  all["verb"] = verb_;
  return all;
}

}  // namespace elastogear::app
