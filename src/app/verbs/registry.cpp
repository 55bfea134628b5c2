#include "app/verbs/registry.h"

#include <algorithm>

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
  Options options(verb.name, verb.table, all_options(verbs));
  options.load(sources);
  return options;
}

}  // namespace elastogear::app
