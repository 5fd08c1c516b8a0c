#include "coordinator/errors/visible.h"

#include <gtest/gtest.h>

#include <string>

namespace tcs {
namespace {

TEST(Visible, WhatCanBeReadStaysAsItIs) {
  const std::string text = "a body's 'mass' – 3 µs, 日本, 🤖";
  EXPECT_EQ(Visible(text), text);
  EXPECT_EQ(Visible(""), "");
}

TEST(Visible, WhatATerminalWouldObeyIsWrittenOut) {
  EXPECT_EQ(Visible("\x1b[31mred\x07"), "\\x1b[31mred\\x07");
  EXPECT_EQ(Visible("two\nlines\tand\r"), "two\\nlines\\tand\\x0d");
  EXPECT_EQ(Visible(std::string("nul\0", 4)), "nul\\x00");
  EXPECT_EQ(Visible("\x7f"), "\\x7f");
  EXPECT_EQ(Visible("\xc2\x9b"
                    "31m"),
            "\\xc2\\x9b31m")
      << "the same as ESC [ in one character";
  EXPECT_EQ(Visible("\xe2\x80\xae"), "\\xe2\\x80\\xae") << "right to left from here on";
}

TEST(Visible, WhatIsNoUtf8IsWrittenOut) {
  EXPECT_EQ(Visible("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(Visible("\xc0\x8a"), "\\xc0\\x8a") << "a line end in two bytes";
  EXPECT_EQ(Visible("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair";
  EXPECT_EQ(Visible("cut \xe2\x80"), "cut \\xe2\\x80");
  EXPECT_EQ(Visible("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Visible, LinesKeepTheirEnds) { EXPECT_EQ(VisibleLines("a\n\x1b\n"), "a\n\\x1b\n"); }

}  // namespace
}  // namespace tcs
