#pragma once
// Files of options in PETSc's own form, one "-name value" a line, and in YAML.

#include <string>
#include <vector>

namespace elastogear::app {

/// Name of an option and the line of the file in which it was given.
struct OptionLine {
  std::string name;  ///< without '-'
  int line = 0;      ///< from 1
};

/// The options in a file that -options_file names, "rc" or "rc:yaml"; it is YAML, too, when PETSc takes it
/// for that, by the end of its name or its first line. Throws Error naming file and line.
std::vector<OptionLine> read_options_file(const std::string& name);

/// The file that is meant: without ":yaml".
std::string path_of_options_file(const std::string& name);

/// Does the option (with '-') name a file of options?
bool names_options_file(const std::string& option);

/// Reads what the value of -options_file, -options_file_yaml or -options_string_yaml names, for its errors
/// alone; nothing for other options.
void check_options_source(const std::string& option, const std::string& value);

}  // namespace elastogear::app
