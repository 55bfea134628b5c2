#include "app/options/option_table.h"

#include <cstddef>
#include <sstream>

namespace elastogear::app {

std::optional<std::string> placeholder(const std::string& pattern, const std::string& name) {
  const auto open = pattern.find('<');
  if (open == std::string::npos) return pattern == name ? std::optional<std::string>("") : std::nullopt;
  const std::string head = pattern.substr(0, open), tail = pattern.substr(pattern.find('>') + 1);
  if (tail.find('<') != std::string::npos) {
    for (std::size_t n = 1; name.starts_with(head) && head.size() + n < name.size(); ++n)
      if (placeholder(tail, name.substr(head.size() + n))) return name.substr(head.size(), n);
    return {};
  }
  if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) return {};
  return name.substr(head.size(), name.size() - head.size() - tail.size());
}

const OptionSpec* find_spec(const OptionTable& table, const std::string& name) {
  const OptionSpec* found = nullptr;
  std::size_t least = 0;
  for (const OptionSpec& spec : table) {
    const auto word = placeholder(spec.name, name);
    if (!word || (found && word->size() >= least)) continue;
    found = &spec;
    least = word->size();
  }
  return found;
}

OptionTable expand(const OptionTable& table, const PlaceholderValues& values) {
  OptionTable result;
  for (const OptionSpec& spec : table) {
    const auto open = spec.name.find('<'), close = spec.name.find('>');
    const auto found =
        open == std::string::npos ? values.end() : values.find(spec.name.substr(open + 1, close - open - 1));
    if (found == values.end()) {
      result.push_back(spec);
      continue;
    }
    for (const std::string& value : found->second) {
      result.push_back(spec);
      result.back().name.replace(open, close - open + 1, value);
    }
  }
  return result;
}

std::string help_text(const OptionTable& table) {
  std::ostringstream out;
  for (const OptionSpec& s : table) {
    if (s.help.empty()) continue;  // another option's help names it
    out << "  -" << s.name << (s.unit == "-" ? "" : " [" + s.unit + "]") << "\n      " << s.help
        << (s.default_value.empty() ? "" : " (default: " + s.default_value + ")") << "\n";
  }
  return out.str();
}

}  // namespace elastogear::app
