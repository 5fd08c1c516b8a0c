// Lines of metrics are found in whatever pieces output comes.
#include "coordinator/metrics/line_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/metrics/metric_line.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

using Lines = std::vector<std::pair<std::int64_t, std::string>>;

Lines Found(const std::vector<std::string>& pieces) {
  Lines lines;
  MetricLineFinder finder;
  const auto on_line = [&](std::string_view line, std::int64_t number) {
    lines.emplace_back(number, line);
  };
  for (const std::string& piece : pieces) finder.Feed(piece, on_line);
  finder.Finish(on_line);
  return lines;
}

TEST(LineFinderTest, FindsThemAmongOthers) {
  EXPECT_THAT(
      Found({"hello\ntcs-metric a 1\n\nsee tcs-metric b 2\ntcs-metrics c 3\ntcs-metric d 4\n"}),
      ElementsAre(Pair(2, "tcs-metric a 1"), Pair(6, "tcs-metric d 4")));
  EXPECT_THAT(Found({}), IsEmpty());
  EXPECT_THAT(Found({"", "\n", ""}), IsEmpty());
}

TEST(LineFinderTest, TakesTheLastLineWithoutAnEnd) {
  EXPECT_THAT(Found({"tcs-metric a 1\ntcs-metric b 2"}),
              ElementsAre(Pair(1, "tcs-metric a 1"), Pair(2, "tcs-metric b 2")));
  EXPECT_THAT(Found({"tcs-met"}), IsEmpty());
}

TEST(LineFinderTest, TellsOfALineWhenItsEndIsThere) {
  MetricLineFinder finder;
  std::string found;
  const auto on_line = [&](std::string_view line, std::int64_t) { found = line; };
  for (const char* piece : {"x\nt", "cs-metric a", " 1"}) {
    finder.Feed(piece, on_line);
    EXPECT_EQ(found, "");
  }
  finder.Feed("7\n", on_line);
  EXPECT_EQ(found, "tcs-metric a 17");
}

TEST(LineFinderTest, FindsTheSameInAnyPieces) {
  std::mt19937 random(1);
  const auto below = [&](std::size_t most) { return random() % most; };
  const std::vector<std::string> parts = {
      "tcs-metric", "tcs-", "metric", " ", "\n", "\n", "a 1", "x", "\r\n", std::string(600, 'y')};
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (std::size_t i = below(20); i > 0; --i) text += parts[below(parts.size())];
    std::vector<std::string> pieces;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t size = 1 + below(below(2) == 0 ? 3 : 700);
      pieces.push_back(text.substr(at, size));
      at += size;
    }
    ASSERT_EQ(Found(pieces), Found({text})) << text;
  }
}

TEST(LineFinderTest, KeepsLittleOfALineWithoutEnd) {
  MetricLineFinder finder;
  std::size_t longest = 0;
  const auto on_line = [&](std::string_view line, std::int64_t) { longest = line.size(); };
  finder.Feed("tcs-metric ", on_line);
  for (int i = 0; i < 1000; ++i) finder.Feed(std::string(1000, 'x'), on_line);
  finder.Feed("\n", on_line);
  EXPECT_EQ(longest, kLongestMetricLine + 1);
}

}  // namespace
}  // namespace tcs
