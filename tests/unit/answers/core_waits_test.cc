#include "coordinator/answers/core_waits.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr CoreWaits::Of kFast{.thread = 1, .client = 0};
constexpr CoreWaits::Of kSlow{.thread = 2, .client = 1};
constexpr CoreWaits::Of kElsewhere{.thread = 3, .client = 2, .robot = 1};

TEST(CoreWaitsTest, OthersOfTheRobotCountFromWhenItWasReady) {
  CoreWaits cores;
  cores.Ready(kSlow, 10);
  cores.Ran(kFast, 5, 30);
  cores.Ran(kElsewhere, 5, 40);
  cores.Ran(kSlow, 30, 50);
  cores.Ran(kFast, 50, 51);
  const CoreWaits::Times times = cores.Stop(kSlow.thread);
  EXPECT_EQ(times.others_ns, (ByClient{{0, 21}}));
  EXPECT_EQ(times.own_ns, 20);
  EXPECT_EQ(cores.ReadySince(kSlow.thread), -1);
}

// The rate loop runs when both timers expire; that the attitude loop is ready, too, is known later.
TEST(CoreWaitsTest, OthersThatRanBeforeItIsKnownToBeReadyCount) {
  CoreWaits cores;
  cores.Ran(kFast, 0, 10);
  cores.Ran(kFast, 100, 194);
  cores.Ready(kSlow, 100);
  EXPECT_EQ(cores.ReadySince(kSlow.thread), 100);
  EXPECT_EQ(cores.Stop(kSlow.thread).others_ns, (ByClient{{0, 94}}));
}

TEST(CoreWaitsTest, SharesAreAsLongAsTheWaitToTheNanosecond) {
  EXPECT_EQ(CoreWaits::Shares({{0, 10}, {1, 20}}, 30), (ByClient{{0, 10}, {1, 20}}));
  EXPECT_EQ(CoreWaits::Shares({{0, 100}, {1, 100}, {2, 100}}, 100),
            (ByClient{{0, 33}, {1, 33}, {2, 34}}));
  EXPECT_EQ(CoreWaits::Shares({{0, 5}}, 0), ByClient{});
  EXPECT_EQ(CoreWaits::Shares({{0, 5}}, -7), ByClient{});
}

}  // namespace
}  // namespace tcs
