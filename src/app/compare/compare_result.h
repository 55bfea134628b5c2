#pragma once
// Deviation of the forces and motions of one result file from those of another.

#include <string>
#include <vector>

#include "app/compare/compare_table.h"
#include "app/options/options.h"

namespace elastogear::app {

/// Tables: values at one time, and signals over the time of contact: contact forces (whole and through each
/// area that the reference touches), penetrations, joint coordinates and rates. Error when the files have no
/// pair of bodies in common.
std::vector<Table> compare_results(const Options& options, const std::string& path,
                                   const std::string& reference_path);

}  // namespace elastogear::app
