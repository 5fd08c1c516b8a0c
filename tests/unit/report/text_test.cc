#include "coordinator/report/text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tcs::report {
namespace {

TEST(Escaping, MarkupInNamesIsText) {
  EXPECT_EQ(Escaped("<script>alert(\"1\") & 'so on'</script>"),
            "&lt;script&gt;alert(&quot;1&quot;) &amp; &#39;so on&#39;&lt;/script&gt;");
}

TEST(Escaping, WhatXmlCannotHoldBecomesASpace) {
  EXPECT_EQ(Escaped(std::string("a\x01\x1b[31mb", 8)), "a  [31mb");
}

TEST(Escaping, WhatIsNoUtf8IsReplaced) {
  EXPECT_EQ(Escaped("Δ = 3 µs, \xf0\x9f\xa6\x8a"), "Δ = 3 µs, \xf0\x9f\xa6\x8a");
  EXPECT_EQ(Escaped("a\xff"
                    "b\xe8"),
            "a\ufffdb\ufffd");
  EXPECT_EQ(Escaped("\xc0\xbc"
                    "script"),
            "\ufffd\ufffdscript");
  EXPECT_EQ(Escaped("\xed\xa0\x80"), "\ufffd\ufffd\ufffd");
}

TEST(Numbers, SignificantDigitsWithoutPowersOfTen) {
  EXPECT_EQ(Significant(0), "0");
  EXPECT_EQ(Significant(9.0649), "9.06");
  EXPECT_EQ(Significant(9.996), "10.0");
  EXPECT_EQ(Significant(0.0935), "0.0935");
  EXPECT_EQ(Significant(168.4), "168");
  EXPECT_EQ(Significant(-1.5), "-1.50");
  EXPECT_EQ(Significant(20010.4), "20\u202f010");
  EXPECT_EQ(Significant(1234.5), "1235");
}

TEST(Numbers, PlainOnesHaveNoZerosForShow) {
  EXPECT_EQ(Plain(5), "5");
  EXPECT_EQ(Plain(2.50), "2.5");
  EXPECT_EQ(Plain(2.0 / 3), "0.667");
  EXPECT_EQ(Plain(100), "100");
}

TEST(Numbers, GroupsOfThreeFromTenThousandOn) {
  EXPECT_EQ(Grouped(9999), "9999");
  EXPECT_EQ(Grouped(20010), "20\u202f010");
  EXPECT_EQ(Grouped(1234567), "1\u202f234\u202f567");
  EXPECT_EQ(Grouped(-1234567), "-1\u202f234\u202f567");
}

TEST(Units, SecondsHaveTheUnitThatFits) {
  EXPECT_EQ(Seconds(0), "0\u00a0s");
  EXPECT_EQ(Seconds(62e-9), "62.0\u00a0ns");
  EXPECT_EQ(Seconds(0.001), "1.00\u00a0ms");
  EXPECT_EQ(Seconds(0.00099996), "1.00\u00a0ms");
  EXPECT_EQ(Seconds(168.4), "168\u00a0s");
}

TEST(Units, WhatIsNotAllOrNothingDoesNotLookLikeIt) {
  EXPECT_EQ(Percent(0), "0\u00a0%");
  EXPECT_EQ(Percent(1), "100\u00a0%");
  EXPECT_EQ(Percent(0.99999), "99.9\u00a0%");
  EXPECT_EQ(Percent(1e-9), "0.001\u00a0%");
  EXPECT_EQ(Percent(0.0197), "2.0\u00a0%");
  EXPECT_EQ(Percent(0.437), "44\u00a0%");
}

TEST(Texts, ListsAndCounts) {
  EXPECT_EQ(Listed(std::vector<std::string>{}), "");
  EXPECT_EQ(Listed(std::vector<std::string>{"a"}), "a");
  EXPECT_EQ(Listed(std::vector<std::string>{"a", "b", "c"}), "a, b and c");
  EXPECT_EQ(Count(1, "trial"), "1 trial");
  EXPECT_EQ(Count(0, "trial"), "0 trials");
}

TEST(Texts, AFileNameHasNoFolders) {
  EXPECT_EQ(FileName("../robots.predator cpu/speed"), "..-robots.predator-cpu-speed");
}

}  // namespace
}  // namespace tcs::report
