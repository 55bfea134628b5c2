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

/// The unit of length of the mesh file or node table in m.
double unit_in_m(const Options& options);
/// The same of a gear of a drive whose mesh is its user's.
double unit_in_m(const Options& options, const std::string& gear);

/// Throws Error unless numbers of the mesh file, such as its materials, have a unit that follows from that of
/// its lengths. what: their name in the message.
void require_consistent_unit(const Options& options, const std::string& what);

}  // namespace elastogear::app
