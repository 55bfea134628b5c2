#pragma once
// The known word that a misspelt one is nearest to.

#include <string>

namespace elastogear::app {

/// How far a word is from another one; smaller is nearer.
struct Misspelling {
  int edits =
      0;  ///< letters inserted, left out, replaced, or two neighbours swapped (optimal string alignment)
  int strange = 0;  ///< letters that the two do not share

  friend auto operator<=>(const Misspelling&, const Misspelling&) = default;
};

Misspelling misspelling(const std::string& a, const std::string& b);

}  // namespace elastogear::app
