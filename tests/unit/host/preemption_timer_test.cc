#include "coordinator/host/preemption_timer.h"

#include <gtest/gtest.h>

#include "tests/unit/host/nanoseconds.h"

namespace tcs {
namespace {

constexpr std::int64_t kComputes = 10 * kMs;  // the longest run of a thread that goes on and on

TEST(PreemptionTimer, IsDueBeforeTheHorizonByWhatTimersAreLate) {
  PreemptionTimer timer;
  const auto late = static_cast<std::int64_t>(timer.lateness_ns());
  EXPECT_EQ(timer.NsToSleep(1e6, kComputes), kMs - late);
}

TEST(PreemptionTimer, LearnsHowLateTimersAre) {
  PreemptionTimer timer;
  for (int i = 0; i < 200; ++i) timer.Expired(kMs, 1e6 + 28e3);
  EXPECT_NEAR(timer.lateness_ns(), 28e3, 10);
  EXPECT_NEAR(static_cast<double>(timer.NsToSleep(1e6, kComputes)), 1e6 - 28e3, 10);
}

TEST(PreemptionTimer, BelievesNeitherATheftNorAnEarlyTimer) {
  PreemptionTimer timer;
  for (int i = 0; i < 200; ++i) timer.Expired(kMs, 300e6);
  EXPECT_NEAR(timer.lateness_ns(), PreemptionTimer::kMostLatenessNs, 10);
  for (int i = 0; i < 400; ++i) timer.Expired(kMs, 0);
  EXPECT_NEAR(timer.lateness_ns(), 0, 10);
}

TEST(PreemptionTimer, IsNeverShorterThanTheSwitchIsWorth) {
  const PreemptionTimer timer;
  EXPECT_EQ(timer.NsToSleep(0, kComputes), PreemptionTimer::kShortestNs);
  EXPECT_EQ(timer.NsToSleep(-1e12, kComputes), PreemptionTimer::kShortestNs);
}

TEST(PreemptionTimer, NobodyComputesForLongUnseen) {
  const PreemptionTimer timer;
  EXPECT_EQ(timer.NsToSleep(50e6, kComputes * 10), PreemptionTimer::kLongestNs);
  EXPECT_EQ(timer.NsToSleep(1e300, kComputes * 1000), PreemptionTimer::kLongestNs);
}

TEST(PreemptionTimer, WhoStopsByItselfLongBeforeItsHorizonGetsALaxOne) {
  const PreemptionTimer timer;
  EXPECT_EQ(timer.NsToSleep(1e6, 15 * kUs), PreemptionTimer::kLaxNs);
  EXPECT_NE(timer.NsToSleep(1e6, 300 * kUs), PreemptionTimer::kLaxNs);
  EXPECT_EQ(timer.NsToSleep(20e3, 15 * kUs), 15 * kUs);  // not if it is about as long
}

TEST(PreemptionTimer, ForgetsALongRunSlowly) {
  std::int64_t longest_ns = PreemptionTimer::LongestOfLate(0, 3 * kMs);
  EXPECT_EQ(longest_ns, 3 * kMs);
  longest_ns = PreemptionTimer::LongestOfLate(longest_ns, 10 * kUs);
  EXPECT_GT(longest_ns, 2 * kMs);
  for (int i = 0; i < 200; ++i) longest_ns = PreemptionTimer::LongestOfLate(longest_ns, 10 * kUs);
  EXPECT_EQ(longest_ns, 10 * kUs);
}

}  // namespace
}  // namespace tcs
