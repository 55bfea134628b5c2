#pragma once
// Whether body files and results are those of a drive as its options have it now.

#include <string>

#include "app/gear/drive_options.h"

namespace elastogear::app {

/// Throws Error unless the body files are those that reduce makes of these options: it names the keys that
/// differ with both values. Files that are not there, and bodies that were reduced without a drive file, are
/// left out.
void require_bodies(const Options& options, const Drive& drive);

/// The first option on which bodies depend that two body files were made of differently, but for how fine
/// their meshes are and how many modes they have; empty: there is none.
std::string differing_option(const std::string& body, const std::string& other);

/// Throws Error unless `file`, a result or what was recovered of it, is of these options: it names the keys
/// that differ with both values. What was made without a drive file is left out.
void require_input(const Options& options, const std::string& file);

}  // namespace elastogear::app
