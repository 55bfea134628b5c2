#pragma once
// JSON as the text of a file.

#include <nlohmann/json.hpp>
#include <string>

namespace elastogear::app {

/// Letters that are not in UTF-8, of names of files and cases, become U+FFFD.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace elastogear::app
