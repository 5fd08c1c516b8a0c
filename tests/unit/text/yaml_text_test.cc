#include "coordinator/text/yaml_text.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(YamlText, NamesThatLookLikeNothingElseStandAsTheyAre) {
  EXPECT_EQ(YamlText("left_wheel-2.joint"), "left_wheel-2.joint");
}

TEST(YamlText, AllOthersAreQuoted) {
  EXPECT_EQ(YamlText("null"), "'null'");
  EXPECT_EQ(YamlText("On"), "'On'");
  EXPECT_EQ(YamlText("1.0"), "'1.0'");
  EXPECT_EQ(YamlText(""), "''");
  EXPECT_EQ(YamlText("joint: it's #1 [x]"), "'joint: it''s #1 [x]'");
  EXPECT_EQ(YamlText("a \\ b"), "'a \\ b'");
}

}  // namespace
}  // namespace tcs
