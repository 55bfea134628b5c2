#include "app/verbs/registry.h"

#include <algorithm>

#include "app/options/command_line.h"
#include "app/options/spelling.h"
#include "elastogear/base/error.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

// The options of all verbs, bare, under the verb's own section ("recover_output"), and those of reduce under
// the name of a drive's gear ("pinion_modes").
OptionTable all_options(const std::vector<Verb>& verbs) {
  OptionTable all;
  for (const Verb& verb : verbs)
    for (const OptionSpec& spec : verb.table) {
      all.push_back(spec);
      all.push_back(spec);
      all.back().name = verb.name + "_" + spec.name;
      if (verb.name != "reduce" || spec.name.starts_with("<gear>")) continue;
      all.push_back(spec);
      all.back().name = "<gear>_" + spec.name;
    }
  return all;
}

// Verbs that make what the others read. Their options may describe a drive on any command line.
const std::vector<std::string> kMakers = {"mesh", "reduce", "simulate"};

bool is_of_section(const std::vector<Verb>& verbs, const std::string& name) {
  return std::ranges::any_of(verbs, [&](const Verb& verb) {
    return name.starts_with(verb.name + "_") && has(verb.table, name.substr(verb.name.size() + 1));
  });
}

// Options of the command line that other verbs alone would read are mistakes. Files may serve several verbs,
// and so may options with the name of their verb, "-recover_csv".
void require_read(const Verb& verb, const std::vector<Verb>& verbs, const OptionSources& sources) {
  for (const GivenOption& option : given_options(sources.argc, sources.argv)) {
    if (!option.place.empty() || is_of_section(verbs, option.name)) continue;
    std::vector<std::string> readers;
    for (const Verb& each : verbs)
      if (has(each.table, option.name)) readers.push_back(each.name);
    const auto serves = [&](const std::string& reader) {
      return reader == verb.name || (verb.name == "run" && reader == "evaluate") ||
             std::ranges::find(kMakers, reader) != kMakers.end();
    };
    require(readers.empty() || std::ranges::any_of(readers, serves), "option -", option.name, " belongs to ",
            join(readers, " and "), "; ", verb.name, " does not read it");
  }
}

}  // namespace

std::vector<Verb> all_verbs() {
  std::vector<Verb> verbs = {run_verb(),      mesh_verb(), reduce_verb(), simulate_verb(), recover_verb(),
                             evaluate_verb(), life_verb(), wear_verb(),   compare_verb(),  info_verb()};
  for (Verb& verb : verbs)
    verb.table.push_back({"verbose", "-", "false", "print every line, not only those that most look for"});
  return verbs;
}

const Verb& find_verb(const std::vector<Verb>& verbs, const std::string& name) {
  for (const Verb& verb : verbs)
    if (verb.name == name) return verb;
  const auto nearest =
      std::ranges::min_element(verbs, {}, [&](const Verb& verb) { return misspelling(name, verb.name); });
  fail("unknown verb '", name, "'; the nearest one is ", nearest->name, "; the verbs are ",
       join(verbs, ", ", &Verb::name));
}

Options load_options(const Verb& verb, const std::vector<Verb>& verbs, const OptionSources& sources) {
  require_read(verb, verbs, sources);
  Options options(verb.name, verb.table, all_options(verbs));
  options.load(sources);
  return options;
}

}  // namespace elastogear::app
