#include <gtest/gtest.h>

#include "../message_of.h"
#include "elastogear/base/error.h"

namespace elastogear::error_test {
namespace {

using test::message_of;

TEST(Error, joins_all_parts_into_one_message) {
  EXPECT_EQ(message_of([] { fail("worm.yaml: nu is ", 0.7, ", allowed are 0..", 0.5); }),
            "worm.yaml: nu is 0.7, allowed are 0..0.5");
}

TEST(Error, shows_numbers_with_ten_digits) {
  EXPECT_EQ(message_of([] { fail(1.0 / 3.0); }), "0.3333333333");
}

TEST(Require, throws_only_when_the_condition_fails) {
  EXPECT_NO_THROW(require(true, "not seen"));
  EXPECT_EQ(message_of([] { require(false, "seen"); }), "seen");
}

TEST(Error, is_caught_as_a_standard_exception) { EXPECT_THROW(fail("x"), std::runtime_error); }

}  // namespace
}  // namespace elastogear::error_test
