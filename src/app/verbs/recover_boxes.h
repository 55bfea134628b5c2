#pragma once
// Pictures of the bounding volumes of recovered bodies.

#include <string>
#include <vector>

#include "app/tables/recover_options.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::app {

/// Files that write_trees() may write for a body; prefix: of the field files.
std::vector<std::string> box_files(const std::string& prefix, const std::string& body);

/// Writes the k-DOPs of all bodies in the world frame at one output time; with two bodies also the leaves
/// that overlap (the paper's Fig. 4). Nothing without levels.
void write_trees(const RecoverSettings& settings, const std::vector<recovery::RecoveredBody>& bodies,
                 Eigen::Index step);

}  // namespace elastogear::app
