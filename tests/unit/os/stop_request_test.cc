#include "coordinator/os/stop_request.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace tcs {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(StopRequest, NobodyHasAskedAtFirst) {
  const StopRequest stop;
  EXPECT_FALSE(stop.asked());
  EXPECT_FALSE(stop.insists());
}

TEST(StopRequest, SignalsOfOneMomentAreOneWish) {
  StopRequest stop;
  stop.Take(SIGINT, 5 * kSecond);
  stop.Take(SIGTERM, 5 * kSecond);
  stop.Take(SIGTERM, 5 * kSecond + kSecond / 2);
  EXPECT_TRUE(stop.asked());
  EXPECT_EQ(stop.signal(), SIGINT);
  EXPECT_FALSE(stop.insists());
}

TEST(StopRequest, ALaterOneInsists) {
  StopRequest stop;
  stop.Take(SIGTERM, 5 * kSecond);
  stop.Take(SIGINT, 6 * kSecond);
  EXPECT_EQ(stop.signal(), SIGTERM);
  EXPECT_TRUE(stop.insists());
}

}  // namespace
}  // namespace tcs
