#include "coordinator/host/starvation_watch.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr double kTicksPerNs = 2.0;
constexpr std::uint64_t kBegun = 1'000'000'000, kLook = 2 * StarvationWatch::kFirstNs + 1;

class StarvationWatchTest : public testing::Test {
 protected:
  StarvationWatch watch_{kBegun, kTicksPerNs};
};

TEST_F(StarvationWatchTest, AsksNothingInAShortRun) {
  EXPECT_FALSE(watch_.IsDue(kBegun));
  EXPECT_FALSE(watch_.IsDue(kBegun + kLook - 1));
  EXPECT_TRUE(watch_.IsDue(kBegun + kLook));
}

TEST_F(StarvationWatchTest, AThreadWhoseClockMovesHasTheProcessor) {
  EXPECT_FALSE(watch_.Starves(kBegun + kLook, 700));
  EXPECT_FALSE(watch_.IsDue(kBegun + kLook + 1));
  EXPECT_FALSE(watch_.Starves(kBegun + 2 * kLook, 701));
}

TEST_F(StarvationWatchTest, AThreadWhoseClockStandsHasNot) {
  EXPECT_FALSE(watch_.Starves(kBegun + kLook, 700));
  EXPECT_TRUE(watch_.Starves(kBegun + 2 * kLook, 700));
}

TEST_F(StarvationWatchTest, AsksHalfAsOftenOnceItHasTold) {
  watch_.Starves(kBegun, 700);
  watch_.Starves(kBegun, 700);
  EXPECT_FALSE(watch_.IsDue(kBegun + kLook));
  EXPECT_TRUE(watch_.IsDue(kBegun + 2 * kLook));
}

TEST_F(StarvationWatchTest, AClockThatCannotBeReadTellsNothing) {
  EXPECT_FALSE(watch_.Starves(kBegun, -1));
  EXPECT_FALSE(watch_.Starves(kBegun, -1));
}

}  // namespace
}  // namespace tcs
