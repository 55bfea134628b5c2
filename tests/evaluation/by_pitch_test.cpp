#include "evaluation/by_pitch.h"

#include <gtest/gtest.h>

namespace elastogear::evaluation::by_pitch_test {
namespace {

Eigen::VectorXd even(double begin, double end, int n) { return Eigen::VectorXd::LinSpaced(n, begin, end); }

TEST(WholePitches, leave_out_what_was_begun_before_and_is_not_ended) {
  const std::vector<PitchOfRun> pitches = whole_pitches(even(0.35, 3.15, 29));
  ASSERT_EQ(pitches.size(), 2U);  // 1 to 2 and 2 to 3
  EXPECT_EQ(pitches[0].begin, 7);
  EXPECT_EQ(pitches[0].end, 17);
  EXPECT_EQ(pitches[1].begin, 17);
  EXPECT_EQ(pitches[1].end, 27);
}

TEST(WholePitches, are_those_of_gears_that_turn_clockwise_too) {
  EXPECT_EQ(whole_pitches(even(-0.35, -3.15, 29)).size(), 2U);
}

TEST(WholePitches, need_four_times_each) {
  EXPECT_EQ(whole_pitches(even(0, 4, 9)).size(), 0U);
  EXPECT_EQ(whole_pitches(even(0, 4, 17)).size(), 3U);
}

TEST(WholePitches, are_none_of_a_run_that_hardly_turns) {
  EXPECT_TRUE(whole_pitches(even(0.1, 0.9, 50)).empty());
  EXPECT_TRUE(whole_pitches({}).empty());
}

}  // namespace
}  // namespace elastogear::evaluation::by_pitch_test
