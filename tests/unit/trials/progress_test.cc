#include "coordinator/trials/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/text/as_time.h"

namespace tcs {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(TrialsRemaining, IsUnknownBeforeAnythingIsKnown) {
  EXPECT_FALSE(RemainingSeconds({.total = 10}).has_value());
  EXPECT_FALSE(RemainingSeconds({.total = 10, .running = {{5.0, 0.0}}}).has_value());
}

TEST(TrialsRemaining, IsEstimatedFromTheFirstTrialBeforeItIsDone) {
  // A quarter in 5 s: 20 s each, of which this one has 15 s to go.
  EXPECT_DOUBLE_EQ(*RemainingSeconds({.total = 3, .running = {{5.0, 0.25}}}), 15.0 + 2 * 20.0);
}

TEST(TrialsRemaining, IsSharedAmongThoseThatRunAtOnce) {
  EXPECT_DOUBLE_EQ(
      *RemainingSeconds({.total = 10, .done = 2, .finished_seconds = {10.0, 10.0}, .at_once = 4}),
      8 * 10.0 / 4);
}

TEST(TrialsRemaining, IsNotLessThanTheLongestOfThoseThatRun) {
  EXPECT_DOUBLE_EQ(*RemainingSeconds({.total = 2,
                                      .done = 1,
                                      .running = {{10.0, 0.1}},
                                      .finished_seconds = {10.0},
                                      .at_once = 8}),
                   90.0);
}

TEST(TrialsRemaining, CountsFailedTrialsAsOver) {
  EXPECT_DOUBLE_EQ(
      *RemainingSeconds({.total = 4, .done = 1, .failed = 2, .finished_seconds = {7.0}}), 7.0);
}

TEST(TrialsLine, SaysHowMuchIsDoneAndForHowLong) {
  EXPECT_EQ(ProgressLine({.total = 4,
                          .done = 1,
                          .failed = 1,
                          .running = {{10.0, 0.5}, {5.0, 0.5}},
                          .finished_seconds = {20.0},
                          .elapsed_seconds = 75.0,
                          .at_once = 2},
                         200),
            "[##################......] 1 of 4 done, 2 running, 1 failed  1:15, about 10 s to go");
}

TEST(TrialsLine, FitsIntoTheTerminal) {
  EXPECT_EQ(ProgressLine({.total = 4}, 30), "[........................] 0 o");
}

TEST(TrialsLine, CountsTheJobsThatWaitInAClustersQueue) {
  EXPECT_THAT(ProgressLine({.total = 4, .running = {{1.0, 0.0}}, .queued = 3}, 200),
              HasSubstr("0 of 4 done, 1 running, 3 queued"));
}

TEST(TrialsLine, ATrialAheadOfItsEndDoesNotOverflowTheBar) {
  EXPECT_THAT(ProgressLine({.total = 1, .running = {{1.0, 1.5}}}, 200),
              HasSubstr("[########################] 0 of 1"));
}

TEST(TrialsTableTest, HasTheMeanOfTimesAndTheWorstOfDrifts) {
  const std::string table =
      TrialsTable({{"drift=1ms",
                    3,
                    {{20, 2'000'000'000, 1'000'000, 0, 1.0}, {20, 4'000'000'000, 900'000, 5, 2.0}}},
                   {"drift=1s", 3, {}}});
  EXPECT_THAT(table, HasSubstr("2 of 3"));
  EXPECT_THAT(table, HasSubstr("3.000 s"));
  EXPECT_THAT(table, HasSubstr("1.000 ms"));
  EXPECT_THAT(table, HasSubstr("5 ns"));
  EXPECT_THAT(table, HasSubstr("1.50 %"));
  EXPECT_THAT(table, HasSubstr("drift=1s      0 of 3\n"));
  EXPECT_THAT(table, Not(HasSubstr("nan")));
}

TEST(TrialsTimes, AreWrittenAsPeopleSayThem) {
  EXPECT_EQ(AsTime(0.4), "0 s");
  EXPECT_EQ(AsTime(59.4), "59 s");
  EXPECT_EQ(AsTime(59.6), "1:00");
  EXPECT_EQ(AsTime(3723), "1:02:03");
  EXPECT_EQ(AsSpan(0), "0 ns");
  EXPECT_EQ(AsSpan(1'000'000), "1.000 ms");
  EXPECT_EQ(AsSpan(168'000'000'000), "168.000 s");
}

}  // namespace
}  // namespace tcs
