#pragma once
// Lists as text, and text on a terminal.

#include <functional>
#include <string>
#include <string_view>

namespace elastogear {

/// The texts of all items with a separator between two of them: "a, b, c". text: of an item, which is a text
/// itself by default.
template <class Items, class Text = std::identity>
std::string join(const Items& items, std::string_view separator = ", ", const Text& text = {}) {
  std::string all;
  bool first = true;
  for (const auto& item : items) {
    if (!first) all += separator;
    all += std::invoke(text, item);
    first = false;
  }
  return all;
}

/// The keys of a map.
template <class Map>
std::string join_keys(const Map& map) {
  return join(map, ", ", [](const auto& entry) { return entry.first; });
}

/// Is the text in UTF-8?
bool is_utf8(std::string_view text);

/// The text with its control characters written out, "\x1b", but for ends of lines and tabs: a terminal would
/// obey those of files that others wrote. UTF-8 stays.
std::string printable(std::string_view text);

}  // namespace elastogear
