#pragma once
// The known word that a misspelt one is nearest to.

#include <string>

namespace elastogear::app {

/// How far a word is from another one; smaller is nearer.
struct Misspelling {
  /// Letters inserted, left out, replaced, or two neighbours swapped (optimal string alignment); 1 for the
  /// first or the last of several words.
  int edits = 0;
  int strange = 0;  ///< letters that the two do not share

  friend auto operator<=>(const Misspelling&, const Misspelling&) =
      default;  // NOLINT(modernize-use-nullptr): a fault of clang-tidy 14
};

Misspelling misspelling(const std::string& a, const std::string& b);

}  // namespace elastogear::app
