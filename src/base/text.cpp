#include "elastogear/base/text.h"

#include <cstdio>

namespace elastogear {

bool is_utf8(std::string_view text) {
  constexpr unsigned char kAscii = 0x80,
                          kMore = 0xC0;  // the first byte of others, and of those that follow it
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < kAscii) continue;
    const std::size_t more = c >= 0xF0 ? 3 : c >= 0xE0 ? 2 : 1;
    if (c < 0xC2 || c > 0xF4 || i + more >= text.size()) return false;
    for (std::size_t k = 1; k <= more; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & kMore) != kAscii) return false;
    i += more;
  }
  return true;
}

std::string printable(std::string_view text) {
  constexpr unsigned char kFirstVisible = 0x20, kDelete = 0x7F, kLead = 0xC2, kLastControl = 0x9F;
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    // U+0080 to U+009F, of which one begins sequences as "\x1b[" does, are C2 80 to C2 9F in UTF-8.
    const bool of_two = c == kLead && next >= 0x80 && next <= kLastControl;
    if ((c >= kFirstVisible && c != kDelete && !of_two) || c == '\n' || c == '\t') {
      shown += text[i];
      continue;
    }
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", of_two ? next : c);
    shown += code;
    i += of_two;
  }
  return shown;
}

}  // namespace elastogear
