#include "elastogear/base/text.h"

#include <gtest/gtest.h>

namespace elastogear::text_test {
namespace {

TEST(Printable, writes_out_what_a_terminal_would_obey) {
  EXPECT_EQ(printable("a\x1b]0;title\x07z\r\x7f"), "a\\x1b]0;title\\x07z\\x0d\\x7f");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\x9b31m");
}

TEST(Printable, leaves_text_as_it_is) {
  const std::string text = "B\xC3\x9CGEL \xC2\xB5m\n\tone line\n";
  EXPECT_EQ(printable(text), text);
}

TEST(Utf8, is_known_by_the_bytes_of_its_letters) {
  EXPECT_TRUE(is_utf8("plain"));
  EXPECT_TRUE(is_utf8("h\xC3\xB6her \xE2\x82\xAC \xF0\x9F\x94\xA7"));
  EXPECT_FALSE(is_utf8("h\xF6her"));        // Latin-1
  EXPECT_FALSE(is_utf8("h\xC3"));           // cut off
  EXPECT_FALSE(is_utf8("\xE2\x82 after"));  // cut off within
  EXPECT_FALSE(is_utf8("\xC0\xAF"));        // longer than it need be
}

}  // namespace
}  // namespace elastogear::text_test
