#pragma once
// elastogear VERB [FILE ...] [-option value ...], and what PETSc would not start with.

#include <string>
#include <vector>

namespace elastogear::app {

struct CommandLine {
  std::string verb;
  std::vector<std::string> arguments;  ///< words before the first option
  bool help = false, version = false;
};

CommandLine parse_command_line(int argc, char** argv);

/// Does PETSc take this word for the name of an option, not for a value? "-1e-7" is a value.
bool is_option(const std::string& word);

/// Throws Error for words that belong to no option, and for files and texts of options (-options_file,
/// -options_file_yaml, -options_string_yaml) that cannot be read. To be called before PETSc is started, which
/// ends with a traceback there.
void check_words(int argc, char** argv);

}  // namespace elastogear::app
