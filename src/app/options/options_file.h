#pragma once
// Files of options in PETSc's own form, one "-name value" a line, and in YAML.

#include <string>
#include <vector>

namespace elastogear::app {

/// An option that the command line, or a file that it names, gives.
struct GivenOption {
  std::string name, value;  ///< without '-'; empty where no value is given
  std::string place = {};   ///< "file.txt, line 3"; empty: the command line itself
};

/// The options in a file that -options_file names, "rc" or "rc:yaml"; it is YAML, too, when PETSc takes it
/// for that, by the end of its name or its first line. Throws Error naming file and line.
std::vector<GivenOption> read_options_file(const std::string& name);

/// All options of words "-name value", in their order; in place of those that name a file or a text of
/// options what it holds. Prefixes (-prefix_push) and aliases are resolved, as PETSc does. Throws Error
/// naming file and line, also where files of options name each other without end.
std::vector<GivenOption> expanded(const std::vector<GivenOption>& words);

/// The file that is meant: without ":yaml".
std::string path_of_options_file(const std::string& name);

/// Does the option (without '-') name a file of options? Those with variables of the environment in their
/// names are left to PETSc.
bool names_options_file(const GivenOption& option);

}  // namespace elastogear::app
