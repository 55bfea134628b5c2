#pragma once
// Options of the gear data, which `mesh` makes bodies of and `simulate` takes exact flanks from.

#include "app/options/rows.h"
#include "elastogear/gear/design.h"

namespace elastogear::app {

/// The rows of a gear::Design, with part, size and mesh, which are read elsewhere.
const Rows<gear::Design>& design_rows();

/// Which of the two bodies is the option part?
bool is_worm(const Options& options);

}  // namespace elastogear::app
