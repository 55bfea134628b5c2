#pragma once
// elastogear VERB [FILE ...] [-option value ...], and what PETSc would not start with.

#include <string>
#include <vector>

#include "app/options/options_file.h"

namespace elastogear::app {

struct CommandLine {
  std::string verb;
  std::vector<std::string> arguments;  ///< words before the first option
  bool help = false, version = false;
  std::string help_about = {};  ///< the word after -help
};

CommandLine parse_command_line(int argc, char** argv);

/// Does PETSc take this word for the name of an option, not for a value? "-1e-7" is a value.
bool is_option(const std::string& word);

/// The options of the command line, with those of files and texts that it names (-options_file,
/// -options_file_yaml, -options_string_yaml) in their places. Throws Error for words that belong to no
/// option, and for files and texts that cannot be read. To be called before PETSc is started, which ends with
/// a traceback there.
std::vector<GivenOption> given_options(int argc, char** argv);

/// The words that PETSc gets of these options, the name of the program first: what it may know. All others
/// would fill its database, which takes 512.
std::vector<std::string> words_of_petsc(const std::string& program, const std::vector<GivenOption>& options);

}  // namespace elastogear::app
