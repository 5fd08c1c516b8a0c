#include "coordinator/os/timer_descriptor.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <cstdint>

namespace tcs {
namespace {

std::uint64_t Read(int fd) {
  std::uint64_t count = 0;
  return read(fd, &count, sizeof count) == sizeof count ? count : 0;
}

TEST(TimerDescriptor, IsToldFromOthers) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_FALSE(IsTimerDescriptor(ends[0]));
  EXPECT_FALSE(IsTimerDescriptor(eventfd(0, 0)));
  EXPECT_FALSE(IsTimerDescriptor(open("/dev/null", O_RDWR)));
  EXPECT_FALSE(IsTimerDescriptor(-1));
  const int fd = timerfd_create(CLOCK_MONOTONIC, 0);
  EXPECT_TRUE(IsTimerDescriptor(fd));
  EXPECT_FALSE(IsOfRealtime(fd));
  EXPECT_TRUE(IsOfRealtime(timerfd_create(CLOCK_REALTIME, 0)));
}

TEST(TimerDescriptor, CountsWhatNobodyHasRead) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, 0);
  EXPECT_TRUE(AddExpirations(fd, 3));
  EXPECT_TRUE(AddExpirations(fd, 4));
  EXPECT_EQ(Read(fd), 7u);
  EXPECT_TRUE(AddExpirations(fd, 2));
  EXPECT_EQ(Read(fd), 2u);
  EXPECT_FALSE(AddExpirations(fd, 0));
  EXPECT_FALSE(AddExpirations(fd, -5));
}

// Of a descriptor whose reads wait, which a client can set at any time.
TEST(TimerDescriptor, ForgetsWithoutWaiting) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, 0);
  ForgetExpirations(fd);
  AddExpirations(fd, 5);
  ForgetExpirations(fd);
  ASSERT_EQ(fcntl(fd, F_SETFL, O_NONBLOCK), 0);
  EXPECT_EQ(Read(fd), 0u);
}

TEST(TimerDescriptor, TakesAllThatCanBeCounted) {
  const int fd = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(AddExpirations(fd, INT64_MAX));
  EXPECT_EQ(Read(fd), UINT64_MAX);
}

}  // namespace
}  // namespace tcs
