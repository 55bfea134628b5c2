#pragma once
// Variables of the environment that libraries read as they are loaded, before main() can set them.

#include <string>
#include <utility>
#include <vector>

namespace elastogear::app {

/// Names and values that the verb runs faster with; those that the user has set are left out.
std::vector<std::pair<std::string, std::string>> missing_settings(const std::string& verb);

/// Starts this program again with these settings; returns where there are none. To be called before MPI
/// starts. argv: that of main, ended by a null pointer.
void start_with_settings(const std::string& verb, char** argv);

}  // namespace elastogear::app
