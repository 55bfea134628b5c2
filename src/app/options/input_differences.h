#pragma once
// What the options in force say otherwise than those that a file was made of, which its provenance holds.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/options/options.h"

namespace elastogear::app {

/// Weight of an option in a comparison. none: the file does not depend on it; of_files: the file belongs to
/// what input files say, from which the command line that made it may have departed; of_command: which may
/// not, but what the program itself has set may; always: the values must be the same.
enum class Weight { none, of_files, of_command, always };

/// An option, or a file that one names, that differs.
struct InputDifference {
  std::string name, there, here;  ///< option; values with units, in the provenance and in force
  bool allowed = false;           ///< another command line, or the program, alone makes it
  bool of_command_line = false;   ///< the command line that made the file said it
};

/// All options of some weight whose values differ.
std::vector<InputDifference> input_differences(const Options& now,
                                               const std::map<std::string, std::string>& then,
                                               const std::function<Weight(const std::string&)>& weight);

/// "torque 300 N m there, 400 N m here" of those that are not allowed; empty: there are none.
std::string refused_text(const std::vector<InputDifference>& differences);

/// Fingerprint of the contents of a file, as the provenance has it by fingerprint_key().
std::string file_fingerprint(const std::string& file);
inline std::string fingerprint_key(const std::string& file) { return "fingerprint_" + file; }

}  // namespace elastogear::app
