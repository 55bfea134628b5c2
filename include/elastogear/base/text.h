#pragma once
// Lists as text.

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

}  // namespace elastogear
