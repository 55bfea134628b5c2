#pragma once
// Deviation of the stresses of one file from those of another.

#include <string>
#include <vector>

#include "app/compare/compare_table.h"
#include "app/options/options.h"

namespace elastogear::app {

/// Tables: in percent of each measure (the paper's Tab. 3), in percent of the local von Mises stress, and
/// signals over time at the peak nodes. Error when the files have no set of nodes in common.
std::vector<Table> compare_stresses(const Options& options, const std::string& path,
                                    const std::string& reference_path);

}  // namespace elastogear::app
