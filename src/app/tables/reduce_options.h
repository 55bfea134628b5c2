#pragma once
// The options of reduce.

#include "app/options/options.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::app {

/// The name of the node set that option restrain_nodes makes.
inline constexpr const char* kListedNodes = "restrain_nodes";

/// Rows for all options of reduce.
OptionTable reduce_table();

/// Materials and restraint are left empty where the mesh file is to give them.
reduction::ReductionOptions reduction_options(const Options& options);

}  // namespace elastogear::app
