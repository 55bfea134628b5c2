#pragma once
// Text to number and back, without locale.

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace elastogear {

/// The number that makes up all of `text` (a leading + is allowed), or nothing.
template <class T>
std::optional<T> parse(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// Appends the shortest text that reads back as the same number.
template <class T>
void print(std::string& out, T value) {
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

}  // namespace elastogear
