// Numbers as the screen has them.
#include "app/console/console.h"

#include <gtest/gtest.h>

#include "app/evaluate/evaluate_tables.h"

namespace elastogear::app::console_test {
namespace {

TEST(Console, percents_have_two_digits_below_ten_and_none_behind_the_point_above) {
  EXPECT_EQ(percent(0.00012), "0.012 %");
  EXPECT_EQ(percent(0.0451), "4.5 %");
  EXPECT_EQ(percent(0.0996), "10 %");
  EXPECT_EQ(percent(0.9956), "100 %");
  EXPECT_EQ(percent(2.642), "264 %");
}

TEST(Console, a_number_with_an_error_ends_with_its_second_digit) {
  EXPECT_EQ(with_error(422.04e6, 5.53e6), "422.0 +- 5.5");
  EXPECT_EQ(with_error(1671e6, 17.2e6), "1671 +- 17");
  EXPECT_EQ(with_error(0.01072e6, 0.00009e6), "0.010720 +- 0.000090");
}

}  // namespace
}  // namespace elastogear::app::console_test
