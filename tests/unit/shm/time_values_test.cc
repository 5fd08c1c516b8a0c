#include "shm/time_values.h"

#include <gtest/gtest.h>

#include <climits>

namespace tcs::shm {
namespace {

TEST(TimeValuesTest, SumsStayAtTheEndOfAllTime) {
  static_assert(AddSaturated(1, 2) == 3);
  static_assert(AddSaturated(kNeverNs, 0) == kNeverNs);
  static_assert(AddSaturated(kNeverNs, 1) == kNeverNs);
  static_assert(AddSaturated(1, kNeverNs) == kNeverNs);
  static_assert(AddSaturated(kNeverNs, -1) == kNeverNs - 1);
  static_assert(AddSaturated(-kNeverNs, -kNeverNs) == -kNeverNs);
  static_assert(UnitsToNs(3, kNsPerSecond) == 3'000'000'000);
  static_assert(UnitsToNs(LONG_MAX, kNsPerSecond) == kNeverNs);
  static_assert(UnitsToNs(LONG_MIN, kNsPerSecond) == -kNeverNs);
}

TEST(TimeValuesTest, ToNs) {
  static_assert(ToNs(timespec{2, 5}) == 2'000'000'005);
  static_assert(ToNs(timeval{2, 5}) == 2'000'005'000);
  static_assert(ToNs(timespec{LONG_MAX, 999'999'999}) == kNeverNs);
  static_assert(ToNs(timeval{LONG_MAX, 999'999}) == kNeverNs);
  // What is not valid does not overflow either.
  static_assert(ToNs(timespec{LONG_MAX, LONG_MAX}) == kNeverNs);
  static_assert(ToNs(timeval{0, LONG_MAX}) == kNeverNs);
  static_assert(ToNs(timespec{LONG_MIN, 0}) == -kNeverNs);
}

TEST(TimeValuesTest, FromNs) {
  constexpr timespec kTime = ToTimespec(2'000'000'005);
  static_assert(kTime.tv_sec == 2 && kTime.tv_nsec == 5);
  // Before the epoch, too, the nanoseconds go forward.
  constexpr timespec kBefore = ToTimespec(-1);
  static_assert(kBefore.tv_sec == -1 && kBefore.tv_nsec == 999'999'999);
  constexpr timeval kDown = ToTimeval(1'999'999'999), kUp = RoundUpToTimeval(1'999'999'001);
  static_assert(kDown.tv_sec == 1 && kDown.tv_usec == 999'999);
  static_assert(kUp.tv_sec == 2 && kUp.tv_usec == 0);
  constexpr timeval kLast = RoundUpToTimeval(kNeverNs);
  static_assert(kLast.tv_sec == kNeverNs / kNsPerSecond);
}

TEST(TimeValuesTest, WhatTheKernelRefuses) {
  static_assert(IsValid(timespec{0, 0}) && IsValid(timespec{LONG_MAX, 999'999'999}));
  static_assert(!IsValid(timespec{-1, 0}) && !IsValid(timespec{0, -1}));
  static_assert(!IsValid(timespec{0, kNsPerSecond}));
  static_assert(IsValid(timeval{0, 999'999}) && !IsValid(timeval{0, 1'000'000}));
  static_assert(!IsValid(timeval{-1, 0}) && !IsValid(timeval{0, -1}));
  static_assert(!IsValid(itimerspec{{0, -1}, {0, 0}}) && !IsValid(itimerspec{{0, 0}, {-1, 0}}));
  static_assert(!IsValid(itimerval{{0, -1}, {0, 0}}) && IsValid(itimerval{}));
}

TEST(TimeValuesTest, MillisecondsBelowZeroAreForEver) {
  static_assert(MillisecondsToNs(-5) == -1);
  static_assert(MillisecondsToNs(0) == 0);
  static_assert(MillisecondsToNs(INT_MAX) == 2'147'483'647'000'000);
}

TEST(TimeValuesTest, ATimerIsArmedForAnythingButZero) {
  static_assert(FirstExpiry(0, false, 100, 0) == 0);
  static_assert(FirstExpiry(0, true, 100, 7) == 0);
  static_assert(FirstExpiry(5, false, 100, 7) == 105);
  static_assert(FirstExpiry(50, true, 100, 7) == 43);
  static_assert(FirstExpiry(5, true, 100, 7) == 1);  // long past
  static_assert(FirstExpiry(kNeverNs, false, 100, 0) == kNeverNs);
}

TEST(TimeValuesTest, WhatIsLeftIsNeverZeroWhileItIsArmed) {
  static_assert(TimeLeft(0, 100) == 0);
  static_assert(TimeLeft(101, 100) == 1);
  static_assert(TimeLeft(100, 100) == 1);
  static_assert(TimeLeft(5, 100) == 1);
  static_assert(TimeLeft(150, 100) == 50);
}

TEST(TimeValuesTest, AlarmIsReadInSeconds) {
  static_assert(AlarmSeconds({0, 0}) == 0);
  static_assert(AlarmSeconds({0, 1}) == 1);
  static_assert(AlarmSeconds({1, 499'999}) == 1);
  static_assert(AlarmSeconds({1, 500'000}) == 2);
}

}  // namespace
}  // namespace tcs::shm
