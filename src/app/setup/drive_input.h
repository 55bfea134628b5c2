#pragma once
// Whether body files and results are those of a drive as its options have it now.

#include <string>
#include <vector>

#include "app/gear/drive_options.h"

namespace elastogear::app {

/// Command lines that may have departed from the drive file where files are compared with it: those of former
/// commands, or none but that in force.
enum class CommandLines { any, present };

/// Throws Error unless the body files are those that reduce makes of these options: it names the keys that
/// differ with both values. Files that are not there, and bodies that were reduced without a drive file, are
/// left out.
void require_bodies(const Options& options, const Drive& drive, CommandLines may_depart = CommandLines::any);

/// The first option on which bodies depend that two body files were made of differently, but for how fine
/// their meshes are and how many modes they have; empty: there is none.
std::string differing_option(const std::string& body, const std::string& other);

/// Throws Error unless `file`, a result or what was recovered of it, is of these options: it names the keys
/// that differ with both values. What was made without a drive file is left out.
void require_input(const Options& options, const std::string& file,
                   CommandLines may_depart = CommandLines::any);

/// Prints what the command lines that made these files said otherwise than the drive file, each once.
void print_departures(const Options& options, const std::vector<std::string>& files);

}  // namespace elastogear::app
