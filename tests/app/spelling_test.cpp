// Which word was meant.
#include "app/options/spelling.h"

#include <gtest/gtest.h>

namespace elastogear::app::spelling_test {
namespace {

TEST(Spelling, CountsEdits) {
  EXPECT_EQ(misspelling("modes", "modes").edits, 0);
  EXPECT_EQ(misspelling("modess", "modes").edits, 1);
  EXPECT_EQ(misspelling("mods", "modes").edits, 1);
  EXPECT_EQ(misspelling("mades", "modes").edits, 1);
  EXPECT_EQ(misspelling("", "modes").edits, 5);
  EXPECT_EQ(misspelling("modes", "").edits, 5);
}

TEST(Spelling, TwoLettersSwappedAreOneEdit) {
  EXPECT_EQ(misspelling("mdoes", "modes").edits, 1);
  EXPECT_EQ(misspelling("ts_td", "ts_dt").edits, 1);
  EXPECT_LT(misspelling("mdoes", "modes"), misspelling("mdoes", "dofs"));
}

TEST(Spelling, AFirstOrLastWordIsOneEdit) {
  EXPECT_EQ(misspelling("helix", "helix_angle").edits, 1);
  EXPECT_EQ(misspelling("angle", "helix_angle").edits, 1);
  EXPECT_GT(misspelling("he", "he_angle").edits, 1);
  EXPECT_LT(misspelling("helix", "helix_angle"), misspelling("helix", "files"));
}

TEST(Spelling, OfEquallyManyEditsCommonLettersDecide) {
  EXPECT_EQ(misspelling("sufrace_", "surface").edits, misspelling("sufrace_", "sufracxx").edits);
  EXPECT_LT(misspelling("sufrace_", "surface"), misspelling("sufrace_", "sufracxx"));
}

}  // namespace
}  // namespace elastogear::app::spelling_test
