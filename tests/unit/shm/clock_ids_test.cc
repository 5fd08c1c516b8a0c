#include "shm/clock_ids.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

namespace tcs::shm {
namespace {

TEST(ClockIdsTest, ClocksOfTime) {
  for (const clockid_t id :
       {CLOCK_REALTIME, CLOCK_REALTIME_COARSE, CLOCK_REALTIME_ALARM, CLOCK_TAI}) {
    EXPECT_EQ(ClockOf(id).kind, ClockKind::kRealtime) << id;
    EXPECT_TRUE(ClockOf(id).IsOfTime()) << id;
  }
  for (const clockid_t id : {CLOCK_MONOTONIC, CLOCK_MONOTONIC_RAW, CLOCK_MONOTONIC_COARSE,
                             CLOCK_BOOTTIME, CLOCK_BOOTTIME_ALARM}) {
    EXPECT_EQ(ClockOf(id).kind, ClockKind::kMonotonic) << id;
    EXPECT_FALSE(ClockOf(id).IsOfCpu()) << id;
  }
}

TEST(ClockIdsTest, SomeAreOnlyRead) {
  for (const clockid_t id : {CLOCK_REALTIME_COARSE, CLOCK_MONOTONIC_COARSE, CLOCK_MONOTONIC_RAW}) {
    EXPECT_TRUE(ClockOf(id).is_read_only) << id;
    timer_t timer;
    EXPECT_NE(timer_create(id, nullptr, &timer), 0) << id;
  }
  EXPECT_TRUE(ClockOf(CLOCK_BOOTTIME_ALARM).is_alarm);
  EXPECT_TRUE(ClockOf(CLOCK_REALTIME_ALARM).is_alarm);
  EXPECT_FALSE(ClockOf(CLOCK_BOOTTIME).is_alarm || ClockOf(CLOCK_BOOTTIME).is_read_only);
}

TEST(ClockIdsTest, ClocksOfProcessorTime) {
  EXPECT_EQ(ClockOf(CLOCK_PROCESS_CPUTIME_ID).kind, ClockKind::kProcessCpu);
  EXPECT_EQ(ClockOf(CLOCK_PROCESS_CPUTIME_ID).owner, 0);
  EXPECT_EQ(ClockOf(CLOCK_THREAD_CPUTIME_ID).kind, ClockKind::kThreadCpu);
  EXPECT_EQ(ClockOf(CLOCK_THREAD_CPUTIME_ID).owner, 0);
}

TEST(ClockIdsTest, ClocksOfOthersSayWhose) {
  clockid_t id;
  ASSERT_EQ(clock_getcpuclockid(getpid(), &id), 0);
  EXPECT_EQ(ClockOf(id).kind, ClockKind::kProcessCpu);
  EXPECT_EQ(ClockOf(id).owner, getpid());
  EXPECT_EQ(CpuClockOf(getpid()), id);
  ASSERT_EQ(pthread_getcpuclockid(pthread_self(), &id), 0);
  EXPECT_EQ(ClockOf(id).kind, ClockKind::kThreadCpu);
  EXPECT_EQ(ClockOf(id).owner, gettid());
  EXPECT_TRUE(ClockOf(id).IsOfCpu());
}

TEST(ClockIdsTest, OnWhichOneCanSleep) {
  constexpr pid_t kSelf = 12;
  const auto error = [](clockid_t id) { return ErrorOfSleepOn(id, kSelf); };
  for (const clockid_t id : {CLOCK_REALTIME, CLOCK_TAI, CLOCK_REALTIME_ALARM, CLOCK_MONOTONIC,
                             CLOCK_BOOTTIME, CLOCK_BOOTTIME_ALARM}) {
    EXPECT_EQ(error(id), 0) << id;
  }
  EXPECT_EQ(error(CLOCK_MONOTONIC_RAW), ENOTSUP);
  EXPECT_EQ(error(CLOCK_PROCESS_CPUTIME_ID), ENOTSUP);
  EXPECT_EQ(error(CLOCK_THREAD_CPUTIME_ID), ENOTSUP);
  EXPECT_EQ(error(CpuClockOf(kSelf)), ENOTSUP);
  EXPECT_EQ(error(77), EINVAL);
  clockid_t own;
  ASSERT_EQ(pthread_getcpuclockid(pthread_self(), &own), 0);
  EXPECT_EQ(ErrorOfSleepOn(own, gettid()), EINVAL);
  EXPECT_EQ(ErrorOfSleepOn(own, gettid() + 1), ENOTSUP);
}

TEST(ClockIdsTest, OnWhichThereAreTimers) {
  for (const clockid_t id : {CLOCK_REALTIME, CLOCK_TAI, CLOCK_MONOTONIC, CLOCK_BOOTTIME,
                             CLOCK_PROCESS_CPUTIME_ID, CLOCK_THREAD_CPUTIME_ID}) {
    EXPECT_EQ(ErrorOfTimerOn(ClockOf(id)), 0) << id;
  }
  EXPECT_EQ(ErrorOfTimerOn(ClockOf(CLOCK_MONOTONIC_RAW)), EOPNOTSUPP);
  EXPECT_EQ(ErrorOfTimerOn(ClockOf(CLOCK_BOOTTIME_ALARM)), EOPNOTSUPP);
  EXPECT_EQ(ErrorOfTimerOn(ClockOf(77)), EINVAL);
}

TEST(ClockIdsTest, OthersAreNone) {
  constexpr clockid_t kOnce = 10, kNobodys = 77;  // CLOCK_SGI_CYCLE, which Linux has no more
  constexpr clockid_t kDevice = ~5 << 3 | 3;      // of /dev/ptp0, for one
  for (const clockid_t id : {kOnce, kNobodys, kDevice}) {
    EXPECT_EQ(ClockOf(id).kind, ClockKind::kNone) << id;
    EXPECT_FALSE(ClockOf(id).IsOfTime() || ClockOf(id).IsOfCpu()) << id;
  }
}

}  // namespace
}  // namespace tcs::shm
