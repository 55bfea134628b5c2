#pragma once
// Tables of options: one per verb says name, unit, default and meaning. Names may hold placeholders.

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace elastogear::app {

/// One option. A name may hold one placeholder, "<body>_file": it stands for any of the names the option list
/// `placeholder_values` gives (verbs with named bodies), or for any word.
struct OptionSpec {
  std::string name;
  std::string unit;           ///< "m", "rad/s", "-" for words and counts
  std::string default_value;  ///< as the user would write it; empty: no default
  std::string help;           ///< empty: that of another option names it
};

using OptionTable = std::vector<OptionSpec>;

/// Values that a placeholder, such as "body", may stand for.
using PlaceholderValues = std::map<std::string, std::vector<std::string>>;

/// The text in `name` that the first placeholder of `pattern` stands for, the least that fits where there are
/// two; nullopt when `name` does not fit.
std::optional<std::string> placeholder(const std::string& pattern, const std::string& name);

/// The row whose placeholder stands for the least, so that "<gear>_pitch_deviation" goes before
/// "<body>_deviation". Null where the table has none of this name.
const OptionSpec* find_spec(const OptionTable& table, const std::string& name);

inline bool has(const OptionTable& table, const std::string& name) { return find_spec(table, name); }

/// The table with "<body>_x" written out for each value of "body".
OptionTable expand(const OptionTable& table, const PlaceholderValues& values);

/// The table as text: option, unit, default, meaning.
std::string help_text(const OptionTable& table);

}  // namespace elastogear::app
