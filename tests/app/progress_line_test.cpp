// Lines of progress: time remaining, width, and when one is due. No clock is involved.
#include "app/console/progress_line.h"

#include <gtest/gtest.h>

namespace elastogear::app::progress_line_test {
namespace {

constexpr int kColumns = 80;

TEST(ProgressLine, TimeRemainingFollowsFromWhatThisRunHasDone) {
  EXPECT_EQ(progress_line({"eigenmodes", 0.25, 0, 10, ""}, kColumns),
            "eigenmodes            25 %  remaining 30 s");
  // Half was done by an earlier run: 10 s for a quarter of the whole, a quarter is left.
  EXPECT_EQ(progress_line({"eigenmodes", 0.75, 0.5, 10, ""}, kColumns),
            "eigenmodes            75 %  remaining 10 s");
}

TEST(ProgressLine, NothingIsForetoldBeforeAnythingIsDone) {
  EXPECT_EQ(progress_line({"static", 0, 0, 4, ""}, kColumns), "static                 0 %  4 s so far");
  EXPECT_EQ(progress_line({"dynamics", 0.5, 0.5, 4, ""}, kColumns),
            "dynamics              50 %  continued, 4 s so far");
  EXPECT_EQ(progress_line({"dynamics", 0.5, 0.5, 2.6e-7, ""}, kColumns),
            "dynamics              50 %  continued");
  EXPECT_EQ(progress_line({"dynamics", 0, 0, 2.6e-7, ""}, kColumns), "dynamics               0 %  begun");
}

TEST(ProgressLine, TheLastLineTellsTheTimeTaken) {
  EXPECT_EQ(progress_line({"fields", 1, 0, 95, ""}, kColumns), "fields               100 %  1 min 35 s");
}

TEST(ProgressLine, PartsThatDoNotFitAreLeftOut) {
  const std::string detail = ", t 0.000123 s, balance 1.23e-05 J, 12 contacts 1e-06 m deep, dt 1e-07 s";
  const std::string line = progress_line({"dynamics", 0.5, 0, 723, detail}, kColumns);
  EXPECT_EQ(line, "dynamics              50 %  remaining 12 min 03 s, t 0.000123 s");
  EXPECT_LE(progress_line({std::string(200, 'x'), 0.5, 0, 723, detail}, kColumns).size(), 80u);
  EXPECT_LE(progress_line({"dynamics", 0.5, 0, 723, detail}, 20).size(), 20u);
}

TEST(LineIsDue, EveryTenSecondsAwayFromATerminal) {
  const StageProgress stage{"dynamics", 0.001, 0, 10.5, ""};
  EXPECT_FALSE(line_is_due(stage, {false, 9}, false, true));
  EXPECT_TRUE(line_is_due(stage, {false, 10.5}, false, true));
}

TEST(LineIsDue, AfterTwentySecondsOfSilence) {
  const StageProgress stage{"eigenmodes", 0, 0, 21, ""};
  EXPECT_FALSE(line_is_due(stage, {false, 19}, false, false));
  EXPECT_TRUE(line_is_due(stage, {false, 21}, false, false));
}

TEST(LineIsDue, AtOnceWhereARunGoesOnAndAtTheEnd) {
  EXPECT_TRUE(line_is_due({"dynamics", 0.4, 0.4, 0, ""}, {false, 0}, true, true));
  EXPECT_FALSE(line_is_due({"dynamics", 0, 0, 0, ""}, {false, 0}, true, true));
  EXPECT_TRUE(line_is_due({"dynamics", 1, 0, 0, ""}, {false, 0}, false, true));
}

TEST(LineIsDue, NotAgainAfterTheEndOfAStage) {
  EXPECT_FALSE(line_is_due({"dynamics", 1, 0, 0, ""}, {false, 100}, false, false));
}

}  // namespace
}  // namespace elastogear::app::progress_line_test
