#include "app/options.h"

#include <slepcsys.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/version.h"

namespace elastogear::app {
namespace {

// First words of options that belong to PETSc, SLEPc and their solvers.
const std::vector<std::string> kPetscPrefixes = {
    "elastic_",  "ts_",     "snes_",  "ksp_",   "pc_",     "mat_",     "vec_",   "eps_",     "st_",
    "bv_",       "ds_",     "rg_",    "fn_",    "sub_",    "log_",     "malloc", "options_", "info",
    "memory_",   "objects", "on_err", "error_", "check_",  "viewfrom", "get_",   "nox",      "fp_",
    "no_signal", "debug",   "stop_",  "start_", "petsc",   "slepc",    "blas_",  "shared_",  "mpi",
    "citations", "saws",    "is_",    "device", "use_gpu", "dm_",      "tao_",   "version",  "help"};

// What the placeholder of `pattern` stands for in `name`; nullopt when it does not fit.
std::optional<std::string> placeholder(const std::string& pattern, const std::string& name) {
  const auto open = pattern.find('<');
  if (open == std::string::npos) return pattern == name ? std::optional<std::string>("") : std::nullopt;
  const std::string head = pattern.substr(0, open), tail = pattern.substr(pattern.find('>') + 1);
  if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) return {};
  return name.substr(head.size(), name.size() - head.size() - tail.size());
}

bool has(const OptionTable& table, const std::string& name) {
  return std::any_of(table.begin(), table.end(),
                     [&](const OptionSpec& s) { return placeholder(s.name, name).has_value(); });
}

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = std::exchange(row[0], static_cast<int>(i));
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitute = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

// Tables with "<body>_x" written out for each value of "body".
OptionTable expand(const OptionTable& table, const PlaceholderValues& values) {
  OptionTable result;
  for (const OptionSpec& spec : table) {
    const auto open = spec.name.find('<'), close = spec.name.find('>');
    const auto found =
        open == std::string::npos ? values.end() : values.find(spec.name.substr(open + 1, close - open - 1));
    if (found == values.end()) {
      result.push_back(spec);
      continue;
    }
    for (const std::string& value : found->second) {
      result.push_back(spec);
      result.back().name.replace(open, close - open + 1, value);
    }
  }
  return result;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    const auto first = part.find_first_not_of(" []"), last = part.find_last_not_of(" []");
    if (first != std::string::npos) parts.push_back(part.substr(first, last - first + 1));
  }
  return parts;
}

double parse_number(const std::string& name, const std::string& text, const std::string& unit) {
  double value = 0;
  const char* begin = text.c_str() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.c_str() + text.size();
  const auto [stop, status] = std::from_chars(begin, end, value);
  require(status == std::errc() && stop == end && std::isfinite(value), "option -", name, " = '", text,
          "': must be a finite number (", unit, ")");
  return value;
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

}  // namespace

Options::Options(std::string verb, OptionTable own, OptionTable known)
    : verb_(std::move(verb)), own_(std::move(own)), known_(std::move(known)) {}

void Options::load(const std::vector<std::string>& files, int argc, char** argv) {
  for (const std::string& file : files) {
    require(std::filesystem::is_regular_file(file), file, ": no such file");
    const PetscErrorCode code =
        PetscOptionsInsertFileYAML(PETSC_COMM_WORLD, nullptr, file.c_str(), PETSC_TRUE);
    require(code == 0, file, ": is no valid YAML (nested maps of keys and values, lists in [a, b] form)");
  }
  const std::string section = verb_ + "_";
  for (const auto& [name, value] : options_in_database())
    if (name.starts_with(section)) {
      check(PetscOptionsSetValue(nullptr, ("-" + name.substr(section.size())).c_str(), value.c_str()));
      check(PetscOptionsClearValue(nullptr, ("-" + name).c_str()));
    }
  given_in_files_ = options_in_database();
  check(PetscOptionsInsert(nullptr, &argc, &argv, nullptr));
  given_ = options_in_database();
  for (auto& [name, value] : given_)  // our own keys count as used; PETSc's are checked after the run
    if (has(known_, name)) check(PetscOptionsHasName(nullptr, nullptr, ("-" + name).c_str(), nullptr));
}

void Options::reject_unknown(const PlaceholderValues& values) const {
  const OptionTable known = expand(known_, values);
  for (const auto& [name, value] : given_) {
    if (has(known, name)) continue;
    const auto is_petsc = [&](const std::string& prefix) { return name.starts_with(prefix); };
    if (std::any_of(kPetscPrefixes.begin(), kPetscPrefixes.end(), is_petsc)) continue;
    const OptionTable candidates = expand(own_, values);
    const auto nearest =
        std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
          return edit_distance(name, a.name) < edit_distance(name, b.name);
        });
    fail("unknown option -", name, value.empty() ? "" : " = '" + value + "'",
         "; the nearest known option is -", nearest->name, " (", nearest->help, "). 'elastogear ", verb_,
         " -help' lists all.");
  }
}

const OptionSpec& Options::spec(const std::string& name) const {
  const auto found = std::find_if(own_.begin(), own_.end(),
                                  [&](const auto& s) { return placeholder(s.name, name).has_value(); });
  require(found != own_.end(), "internal: option -", name, " is in no table of verb ", verb_);
  return *found;
}

bool Options::given(const std::string& name) const { return given_.contains(name); }

std::string Options::text(const std::string& name) const {
  const auto found = given_.find(name);
  const std::string value = found != given_.end() ? found->second : spec(name).default_value;
  require(!value.empty(), "option -", name, " is missing: ", spec(name).help);
  return value;
}

double Options::number(const std::string& name) const {
  return parse_number(name, text(name), spec(name).unit);
}

double Options::positive(const std::string& name) const {
  const double value = number(name);
  require(value > 0, "option -", name, " = ", value, " ", spec(name).unit, ": must be positive");
  return value;
}

int Options::count(const std::string& name, int smallest) const {
  const std::string value = text(name);
  int result = 0;
  const auto [stop, status] = std::from_chars(value.data(), value.data() + value.size(), result);
  require(status == std::errc() && stop == value.data() + value.size() && result >= smallest, "option -",
          name, " = '", value, "': must be a whole number of at least ", smallest);
  return result;
}

bool Options::flag(const std::string& name) const {
  if (given(name) && given_.at(name).empty()) return true;
  return choice(name, {"false", "true", "no", "yes", "0", "1"}) % 2 == 1;
}

Eigen::Vector3d Options::vector(const std::string& name) const {
  const std::vector<double> values = numbers(name);
  require(values.size() == 3, "option -", name, " = '", text(name), "': must be three numbers x,y,z (",
          spec(name).unit, ")");
  return {values[0], values[1], values[2]};
}

std::vector<double> Options::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const std::string& part : list(name)) values.push_back(parse_number(name, part, spec(name).unit));
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

bool Options::is_of_other_verb(const std::string& name) const {
  return !has(own_, name) && has(known_, name);
}

int Options::choice(const std::string& name, const std::vector<std::string>& allowed) const {
  const std::string value = text(name);
  const auto found = std::find(allowed.begin(), allowed.end(), value);
  std::string names;
  for (const std::string& a : allowed) names += (names.empty() ? "" : ", ") + a;
  require(found != allowed.end(), "option -", name, " = '", value, "': must be one of ", names);
  return static_cast<int>(found - allowed.begin());
}

std::vector<std::string> Options::placeholder_values(const std::string& pattern) const {
  std::vector<std::string> values;
  for (const auto& [name, value] : given_)
    if (const auto word = placeholder(pattern, name)) values.push_back(*word);
  return values;
}

std::map<std::string, std::string> Options::provenance() const {
  std::map<std::string, std::string> all;
  for (const OptionSpec& s : own_)
    if (s.name.find('<') == std::string::npos && !s.default_value.empty())
      all["option_" + s.name] = s.default_value;
  for (const auto& [name, value] : given_) all["option_" + name] = value;
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

std::string help_text(const OptionTable& table) {
  std::ostringstream out;
  for (const OptionSpec& s : table) {
    out << "  -" << s.name << (s.unit == "-" ? "" : " [" + s.unit + "]") << "\n      " << s.help
        << (s.default_value.empty() ? "" : " (default: " + s.default_value + ")") << "\n";
  }
  return out.str();
}

}  // namespace elastogear::app
