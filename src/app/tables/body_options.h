#pragma once
// The bodies of simulate: where they come from, their joints, initial states, loads and prescribed motions.

#include <map>
#include <string>

#include "app/options/options.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::app {

/// Rows of the option table of simulate.
OptionTable body_table();

/// The body of this name. Enters into `identities` what its file holds, whatever options leave out of it.
dynamics::BodySetup body_setup(const Options& options, const std::string& name,
                               std::map<std::string, std::string>& identities);

}  // namespace elastogear::app
