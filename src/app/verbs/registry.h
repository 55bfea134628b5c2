#pragma once
// All verbs, and how one of them is run.

#include <string>
#include <vector>

#include "app/options/verbs.h"

namespace elastogear::app {

std::vector<Verb> all_verbs();

/// Throws Error listing the verbs that there are.
const Verb& find_verb(const std::vector<Verb>& verbs, const std::string& name);

/// Options of a verb, from the present database of PETSc too, in which nothing has been asked for yet.
/// Collective.
Options load_options(const Verb& verb, const std::vector<Verb>& verbs, const OptionSources& sources);

}  // namespace elastogear::app
