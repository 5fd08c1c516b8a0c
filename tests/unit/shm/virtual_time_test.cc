#include "shm/virtual_time.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace tcs {
namespace {

TEST(VirtualTime, UnitsAreNanoseconds) {
  EXPECT_EQ(VirtualDuration::Seconds(2).ns(), 2'000'000'000);
  EXPECT_EQ(VirtualDuration::Milliseconds(3).ns(), 3'000'000);
  EXPECT_EQ(VirtualDuration::Microseconds(-4).ns(), -4'000);
  EXPECT_DOUBLE_EQ(VirtualTime::FromNanoseconds(1'500'000'000).seconds(), 1.5);
}

TEST(VirtualTime, NeverStaysNever) {
  const VirtualTime never = VirtualTime::Never();
  EXPECT_TRUE((never + VirtualDuration::Seconds(1)).IsNever());
  EXPECT_TRUE((never - VirtualDuration::Seconds(1)).IsNever());
  EXPECT_LT(VirtualTime::FromNanoseconds(INT64_MAX - 1), never);
}

TEST(VirtualTime, DifferencesAreDurations) {
  const VirtualTime a = VirtualTime::FromNanoseconds(70), b = VirtualTime::FromNanoseconds(100);
  EXPECT_EQ(b - a, VirtualDuration::Nanoseconds(30));
  EXPECT_EQ(a + VirtualDuration::Nanoseconds(30), b);
}

TEST(VirtualTime, HostTimeDoesNotMixIn) {
  EXPECT_FALSE((std::is_convertible_v<HostTime, VirtualTime>));
  EXPECT_FALSE((std::is_convertible_v<HostDuration, VirtualDuration>));
  EXPECT_FALSE((std::is_convertible_v<std::int64_t, VirtualTime>));
}

}  // namespace
}  // namespace tcs
