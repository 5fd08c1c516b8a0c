#include "coordinator/policy/wakeup_latency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace tcs {
namespace {

constexpr VirtualDuration kMedian = VirtualDuration::Microseconds(20),
                          kP99 = VirtualDuration::Microseconds(80);

std::vector<std::int64_t> Drawn(const WakeupLatency& latency, int thread, int count) {
  std::vector<std::int64_t> drawn;
  for (int i = 0; i < count; ++i) drawn.push_back(latency.Of(thread, i).ns());
  return drawn;
}

TEST(WakeupLatencyTest, HasItsMedianAndItsNinetyNinthPercentile) {
  std::vector<std::int64_t> drawn = Drawn(WakeupLatency(kMedian, kP99, 1), 3, 100'000);
  std::sort(drawn.begin(), drawn.end());
  EXPECT_NEAR(static_cast<double>(drawn[50'000]), 20'000, 200);
  EXPECT_NEAR(static_cast<double>(drawn[99'000]), 80'000, 2'000);
  EXPECT_GT(drawn.front(), 0);
  EXPECT_GT(drawn.back(), 120'000);
  EXPECT_LE(drawn.back(), 800'000);
}

TEST(WakeupLatencyTest, NoneTakesMoreThanTenTimesThePercentile) {
  const auto drawn =
      Drawn(WakeupLatency(VirtualDuration::Microseconds(1), VirtualDuration::Milliseconds(10), 1),
            0, 100'000);
  EXPECT_EQ(*std::max_element(drawn.begin(), drawn.end()), 100'000'000);
}

TEST(WakeupLatencyTest, RepeatsForTheThreadAndTheSeed) {
  const auto drawn = Drawn(WakeupLatency(kMedian, kP99, 1), 3, 100);
  EXPECT_EQ(Drawn(WakeupLatency(kMedian, kP99, 1), 3, 100), drawn);
  EXPECT_NE(Drawn(WakeupLatency(kMedian, kP99, 2), 3, 100), drawn);
  EXPECT_NE(Drawn(WakeupLatency(kMedian, kP99, 1), 4, 100), drawn);
}

TEST(WakeupLatencyTest, IsConstantWithoutSpread) {
  EXPECT_EQ(Drawn(WakeupLatency(kMedian, kMedian, 1), 0, 3),
            (std::vector<std::int64_t>{20'000, 20'000, 20'000}));
}

TEST(WakeupLatencyTest, IsNothingUnlessGiven) {
  EXPECT_TRUE(WakeupLatency().IsNone());
  EXPECT_EQ(WakeupLatency().Of(0, 0), VirtualDuration());
  EXPECT_FALSE(WakeupLatency(kMedian, kP99, 1).IsNone());
}

}  // namespace
}  // namespace tcs
