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

}  // namespace
}  // namespace elastogear::text_test
