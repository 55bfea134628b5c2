#include "app/options/spelling.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

namespace elastogear::app {
namespace {

int edits(const std::string& a, const std::string& b) {
  std::vector<int> before(b.size() + 1), last = before, row = before;
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last.back();
}

int strange(const std::string& a, const std::string& b) {
  std::array<int, 256> count{};
  for (unsigned char c : a) ++count[c];
  for (unsigned char c : b) --count[c];
  return std::accumulate(count.begin(), count.end(), 0, [](int sum, int n) { return sum + std::abs(n); });
}

// Is a the first word of b, or its last one, as "helix" is of "helix_angle"?
bool is_part(const std::string& a, const std::string& b) {
  constexpr std::size_t kLeastLetters = 4;
  return a.size() >= kLeastLetters && (b.starts_with(a + "_") || b.ends_with("_" + a));
}

}  // namespace

Misspelling misspelling(const std::string& a, const std::string& b) {
  return {is_part(a, b) ? 1 : edits(a, b), strange(a, b)};
}

}  // namespace elastogear::app
