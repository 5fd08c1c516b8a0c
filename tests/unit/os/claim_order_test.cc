#include "coordinator/os/claim_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tcs {
namespace {

using ::testing::ElementsAre;

bool Nobody(int) { return false; }

TEST(ClaimOrder, OneCpuIsClaimedWhateverElse) {
  EXPECT_THAT(CpusToClaim({3}, Nobody, true), ElementsAre(3));
  EXPECT_THAT(CpusToClaim({3}, Nobody, false), ElementsAre(3));
}

TEST(ClaimOrder, TheFirstOfTwoIsTheLastChoice) {
  EXPECT_THAT(CpusToClaim({1, 0}, Nobody, true), ElementsAre(1, 0));
  EXPECT_THAT(CpusToClaim(
                  {1, 0}, [](int cpu) { return cpu == 1; }, true),
              ElementsAre(1, 0));
}

TEST(ClaimOrder, TheFirstOfTwoIsLeftWhereOrdinaryThreadsWouldHaveNothing) {
  EXPECT_THAT(CpusToClaim({1, 0}, Nobody, false), ElementsAre(1));
}

TEST(ClaimOrder, TheFirstOfMoreIsNeverClaimed) {
  EXPECT_THAT(CpusToClaim({5, 4, 2}, Nobody, true), ElementsAre(5, 4));
}

TEST(ClaimOrder, SharedCpusComeAfterOthers) {
  EXPECT_THAT(CpusToClaim(
                  {3, 2, 1, 0}, [](int cpu) { return cpu > 1; }, true),
              ElementsAre(1, 3, 2));
}

TEST(ClaimOrder, RunsWithoutACpuInCommonAreNoRivals) {
  const std::vector<WaitingRun> runs{{1, 10, {0, 1}}, {2, 11, {2}}, {3, 12, {1, 2}}};
  const std::vector<WaitingRun> rivals = RivalsOf({1}, runs);
  ASSERT_EQ(rivals.size(), 2u);
  EXPECT_EQ(rivals[0].ticket, 1);
  EXPECT_EQ(rivals[1].ticket, 3);
  EXPECT_TRUE(IsAwaited(2, runs));
  EXPECT_FALSE(IsAwaited(3, runs));
}

TEST(ClaimOrder, RunsShareTheCpuThatFewestShare) {
  const auto sharers = [](int cpu) { return static_cast<std::size_t>(cpu == 1 ? 1 : 2); };
  EXPECT_EQ(CpuToShare({2, 1, 0}, Nobody, sharers), 1);
  EXPECT_EQ(CpuToShare({2, 1, 0}, Nobody, [](int) { return std::size_t{0}; }), 2);
}

TEST(ClaimOrder, RunsShareAClaimedCpuOnlyWhereAllAreClaimed) {
  const auto sharers = [](int cpu) { return static_cast<std::size_t>(cpu == 0 ? 9 : 0); };
  EXPECT_EQ(CpuToShare(
                {2, 1, 0}, [](int cpu) { return cpu > 0; }, sharers),
            0);
  EXPECT_EQ(CpuToShare(
                {2, 1, 0}, [](int) { return true; }, sharers),
            2);
}

TEST(ClaimOrder, ARunSaysItsPlace) {
  EXPECT_EQ(PlaceInWords(0), "this run is the next one");
  EXPECT_EQ(PlaceInWords(1), "1 run is ahead of this one");
  EXPECT_EQ(PlaceInWords(9), "9 runs are ahead of this one");
}

}  // namespace
}  // namespace tcs
