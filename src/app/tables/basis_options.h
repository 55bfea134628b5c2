#pragma once
// The options of `reduce` that choose the basis.

#include "app/options/options.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::app {

OptionTable basis_table();

/// Sets basis, flexibility, ritz, loaded and n_modes.
void set_basis(const Options& options, reduction::ReductionOptions& o);

}  // namespace elastogear::app
