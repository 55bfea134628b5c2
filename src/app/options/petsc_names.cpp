#include "app/options/petsc_names.h"

#include <link.h>
#include <petscts.h>
#include <slepceps.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

constexpr std::size_t kShortest = 3,
                      kLongest = 80;  // characters of a name; shorter ones are parts of messages

// Types and options of this program, registered when the run begins.
const std::map<std::string, std::string> kOwnTypes = {
    {"ts_type", "generalized_alpha"}, {"eps_type", "block_lanczos"}, {"pc_type", "ldl"}};
constexpr const char* kOwnOptions[] = {"eps_block_lanczos_window", "eps_block_lanczos_block",
                                       "eps_block_lanczos_count"};

// PETSc asks for these when it ends.
constexpr std::string_view kAskedAtEnd[] = {"citations", "get_total_flops", "no_signal_handler",
                                            "options_left", "options_view"};

// Literals of the libraries, sorted.
struct Literals {
  std::vector<std::string> names;     // of options
  std::vector<std::string> prefixes;  // of nested solvers: "mg_levels_%d_"
};

bool may_be_in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '%'; }

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kLongest && std::isalpha(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), may_be_in_name);
}

// In small letters; numbers are "%d", which with 64-bit indices are "%lld" or "%ld".
std::string folded(std::string_view name) {
  std::string small(name);
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const std::string_view number : {"%lld", "%ld"})
    for (auto at = small.find(number); at != std::string::npos; at = small.find(number, at))
      small.replace(at, number.size(), "%d");
  return small;
}

// A linker keeps a literal that is the end of another one inside that one: "esteig_" in
// "-ksp_chebyshev_esteig_".
void add_prefixes(std::string_view text, Literals& literals) {
  const auto begins_word = [&](std::size_t i) {
    return i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1]));
  };
  for (std::size_t i = 0; i + kShortest <= text.size(); ++i)
    if (begins_word(i) && is_name(text.substr(i))) literals.prefixes.push_back(folded(text.substr(i)));
}

void add_literal(std::string_view text, Literals& literals) {
  const auto dash = text.rfind('-');
  const std::string_view word = text.substr(dash == text.npos ? text.size() : dash + 1);
  if (word.size() >= kShortest && is_name(word.substr(word.starts_with("%s_") ? 3 : 0)))
    literals.names.push_back(folded(word));
  if (text.ends_with('_')) add_prefixes(text.substr(text.size() - std::min(text.size(), kLongest)), literals);
  if (text.starts_with("%s") && text.ends_with('_')) add_prefixes(text.substr(2), literals);
}

void read_text(std::string_view memory, Literals& literals) {
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  std::size_t begin = 0;
  for (std::size_t i = 0; i < memory.size(); ++i) {
    if (printable(memory[i])) continue;
    if (memory[i] == '\0' && i > begin) add_literal(memory.substr(begin, i - begin), literals);
    begin = i + 1;
  }
}

bool holds(const dl_phdr_info& object, const ElfW(Phdr) & segment, ElfW(Addr) address) {
  const ElfW(Addr) begin = object.dlpi_addr + segment.p_vaddr;
  return segment.p_type == PT_LOAD && address >= begin && address - begin < segment.p_memsz;
}

// Constant text of the objects that PETSc's and SLEPc's code is in.
int visit_object(dl_phdr_info* object, std::size_t, void* data) {
  const ElfW(Addr) code[] = {reinterpret_cast<ElfW(Addr)>(&TSSetFromOptions),
                             reinterpret_cast<ElfW(Addr)>(&EPSSetFromOptions)};
  const auto* first = object->dlpi_phdr;
  const auto* end = first + object->dlpi_phnum;
  const bool wanted = std::any_of(std::begin(code), std::end(code), [&](ElfW(Addr) address) {
    return std::any_of(first, end, [&](const auto& segment) { return holds(*object, segment, address); });
  });
  for (const auto* segment = first; wanted && segment != end; ++segment) {
    const bool constant = segment->p_type == PT_LOAD && (segment->p_flags & (PF_R | PF_W | PF_X)) == PF_R;
    const auto* memory = reinterpret_cast<const char*>(object->dlpi_addr + segment->p_vaddr);
    if (constant) read_text({memory, segment->p_filesz}, *static_cast<Literals*>(data));
  }
  return 0;
}

Literals read_literals() {
  Literals literals;
  dl_iterate_phdr(visit_object, &literals);
  // "mg_levels_%d_" stands for all levels without its number.
  const std::string number = "%d_";
  for (std::size_t i = 0, n = literals.prefixes.size(); i < n; ++i)
    if (const auto at = literals.prefixes[i].rfind(number); at != std::string::npos && at > 0)
      literals.prefixes.push_back(std::string(literals.prefixes[i]).erase(at, number.size()));
  literals.prefixes.push_back("elastic_");  // of this program's own solver
  literals.names.insert(literals.names.end(), std::begin(kOwnOptions), std::end(kOwnOptions));
  sort_unique(literals.names);
  sort_unique(literals.prefixes);
  const auto found = [&](const char* name) {
    return std::binary_search(literals.names.begin(), literals.names.end(), name);
  };
  if (!found("ts_dt") || !found("ksp_rtol") || !found("eps_tol") || !found("log_view"))
    literals.names.clear();
  return literals;
}

const Literals& literals() {
  static const Literals all = read_literals();
  return all;
}

// Adds to `ends` the places in `text` where `pattern` can end when it begins at `at`; %d stands for a number,
// %s for a word.
void match(std::string_view pattern, std::string_view text, std::size_t at, std::vector<std::size_t>& ends) {
  while (!pattern.empty() && pattern[0] != '%') {
    if (at == text.size() || text[at] != pattern[0]) return;
    pattern.remove_prefix(1);
    ++at;
  }
  if (pattern.empty()) return ends.push_back(at);
  const bool number = pattern.size() > 1 && pattern[1] == 'd';
  pattern.remove_prefix(std::min<std::size_t>(2, pattern.size()));
  while (at < text.size() && (!number || std::isdigit(static_cast<unsigned char>(text[at]))))
    match(pattern, text, ++at, ends);
}

bool is_library_option(std::string_view name) {
  const Literals& all = literals();
  if (std::binary_search(all.names.begin(), all.names.end(), name)) return true;
  return std::any_of(all.names.begin(), all.names.end(), [&](const std::string& pattern) {
    std::vector<std::size_t> ends;
    if (pattern.find('%') != pattern.npos) match(pattern, name, 0, ends);
    return std::find(ends.begin(), ends.end(), name.size()) != ends.end();
  });
}

// Returns whether `name` is at most `depth` prefixes and an option of an object that solvers nest.
bool is_nested(std::string_view name, int depth) {
  constexpr std::string_view kNested[] = {"bv_", "eps_", "ksp_", "lme_", "mat_", "pc_", "snes_", "st_"};
  const auto begins = [&](std::string_view object) { return name.starts_with(object); };
  if (std::any_of(std::begin(kNested), std::end(kNested), begins) && is_library_option(name)) return true;
  if (depth == 0) return false;
  for (const std::string& prefix : literals().prefixes) {
    std::vector<std::size_t> ends;
    match(prefix, name, 0, ends);
    for (std::size_t end : ends)
      if (is_nested(name.substr(end), depth - 1)) return true;
  }
  return false;
}

struct Types {
  const char* option;
  PetscErrorCode (*initialize)();
  PetscFunctionList* list;
};

std::vector<std::string> names_of(const Types& types) {
  const char** names = nullptr;
  int n = 0;
  check(types.initialize());
  check(PetscFunctionListGet(*types.list, &names, &n));
  std::vector<std::string> all;
  for (const char** name = names; name != names + n; ++name)
    if (*name) all.push_back(*name);  // the last one may be none
  check(PetscFree(names));
  if (const auto own = kOwnTypes.find(types.option); own != kOwnTypes.end()) all.push_back(own->second);
  return all;
}

}  // namespace

void check_petsc_type(const std::string& label, const std::string& name, const std::string& value) {
  const Types all[] = {
      {"eps_type", EPSInitializePackage, &EPSList},    {"st_type", STInitializePackage, &STList},
      {"snes_type", SNESInitializePackage, &SNESList}, {"ts_type", TSInitializePackage, &TSList},
      {"ksp_type", KSPInitializePackage, &KSPList},    {"pc_type", PCInitializePackage, &PCList}};
  for (const Types& types : all) {
    const bool nests = types.list == &KSPList || types.list == &PCList;
    const bool ends_so = name.ends_with(types.option);
    const std::size_t begin = ends_so ? name.size() - std::string_view(types.option).size() : 0;
    if (!ends_so || (begin > 0 && !(nests && name[begin - 1] == '_'))) continue;
    const std::vector<std::string> allowed = names_of(types);
    require(std::find(allowed.begin(), allowed.end(), value) != allowed.end(), label, " = '", value,
            "': must be one of ", join(allowed));
  }
}

void check_petsc_limits(const std::string& label, const std::string& name, const std::string& value) {
  constexpr double kLargest = 0.1;
  constexpr const char *kTolerances[] = {"snes_rtol", "snes_stol", "ksp_rtol", "eps_tol"},
                       *kIterations[] = {"snes_max_it", "ksp_max_it", "eps_max_it"};
  const auto is_one = [&](const char* option) {
    const std::string tail = "_" + std::string(option);
    return name == option || name.ends_with(tail);
  };
  const auto number = parse<double>(value);
  if (!number) return;  // PETSc says so
  if (std::any_of(std::begin(kTolerances), std::end(kTolerances), is_one))
    require(*number >= 0 && *number <= kLargest, label, " = ", value, ": must be 0 to ", kLargest,
            "; nothing is solved with more");
  if (std::any_of(std::begin(kIterations), std::end(kIterations), is_one))
    require(*number >= 1, label, " = ", value, ": must be at least 1");
}

const std::vector<std::string>& petsc_names() { return literals().names; }

bool is_petsc_name(const std::string& name) {
  constexpr int kMostPrefixes = 6;
  const std::string small = folded(name);
  return petsc_names().empty() || is_library_option(small) || is_nested(small, kMostPrefixes);
}

std::vector<std::string> unused_petsc_options() {
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &n, &names, &values));
  std::vector<std::string> unused(names, names + n);
  check(PetscOptionsLeftRestore(nullptr, &n, &names, &values));
  std::erase_if(unused, [](const std::string& name) {
    return std::find(std::begin(kAskedAtEnd), std::end(kAskedAtEnd), name) != std::end(kAskedAtEnd);
  });
  return unused;
}

}  // namespace elastogear::app
