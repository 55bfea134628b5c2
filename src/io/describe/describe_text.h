#pragma once
// Lines of the descriptions of files. Private to module io.

#include <map>
#include <sstream>
#include <string>

namespace elastogear::io {

using Out = std::ostringstream;

template <class... Parts>
void line(Out& out, const Parts&... parts) {
  (out << ... << parts) << '\n';
}

inline std::string counted(std::size_t n, const std::string& thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

inline void describe_map(Out& out, const std::map<std::string, std::string>& provenance) {
  if (provenance.empty()) return;
  line(out, "provenance:");
  for (const auto& [key, value] : provenance) line(out, "  ", key, ": ", value);
}

}  // namespace elastogear::io
