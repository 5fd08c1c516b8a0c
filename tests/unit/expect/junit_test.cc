// JUnit XML of any text.
#include "coordinator/expect/junit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tcs {
namespace {

using testing::HasSubstr;

TEST(JunitText, CountsAndEscapes) {
  const std::string text =
      JunitText({{"a<b",
                  1.5,
                  {{"r/c", "misses", "", ""},
                   {"chain a->b", "age \"p99\"", "1 & \x01\xff\n\xc3\xa9", "x"}}}});
  EXPECT_THAT(text, HasSubstr("<testsuites name=\"tcsim\" tests=\"2\" failures=\"1\""));
  EXPECT_THAT(text, HasSubstr("<testsuite name=\"a&lt;b\" tests=\"2\" failures=\"1\""));
  EXPECT_THAT(text, HasSubstr("<testcase classname=\"r/c\" name=\"misses\"/>"));
  EXPECT_THAT(text, HasSubstr("classname=\"chain a-&gt;b\" name=\"age &quot;p99&quot;\""));
  EXPECT_THAT(text, HasSubstr("message=\"1 &amp; ??&#10;\xc3\xa9\">x</failure>"));
}

TEST(JunitText, HasNoCharacterThatXmlLacks) {
  const std::string text =
      JunitText({{"\xed\xa0\x80 \xef\xbf\xbf \xc0\xaf \xf4\x90\x80\x80 \xe2\x82", 0, {}}});
  EXPECT_THAT(text, HasSubstr("name=\"??? ??? ?? ???? ??\""));
}

}  // namespace
}  // namespace tcs
