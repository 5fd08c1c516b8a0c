#include "coordinator/host/stolen_time.h"

#include <gtest/gtest.h>

#include "tests/unit/host/nanoseconds.h"

namespace tcs {
namespace {

TEST(UnaccountedSteal, NothingIsStolenFromATurnThatEndsBeforeItsTimerIsDue) {
  EXPECT_EQ(UnaccountedSteal({.counted_ns = 3 * kMs, .asked_ns = 4 * kMs, .usual_ns = 15'000}), 0);
}

TEST(UnaccountedSteal, ATimerMayBeLate) {
  EXPECT_EQ(
      UnaccountedSteal(
          {.counted_ns = kMs / 2 + kMostTimerLatenessNs, .asked_ns = kMs / 2, .usual_ns = kMs / 2}),
      0);
}

TEST(UnaccountedSteal, NobodyComputesBeyondTheTimer) {
  EXPECT_EQ(UnaccountedSteal({.counted_ns = 201 * kMs, .asked_ns = 2 * kMs, .usual_ns = 50 * kMs}),
            199 * kMs);
}

TEST(UnaccountedSteal, AThreadOfShortTurnsKeepsItsUsualOne) {
  EXPECT_EQ(UnaccountedSteal({.counted_ns = 201 * kMs, .asked_ns = 4 * kMs, .usual_ns = 15'000}),
            201 * kMs - 15'000);
}

TEST(UnaccountedSteal, WhatItsClockHasShownIsTheThreads) {
  EXPECT_EQ(
      UnaccountedSteal(
          {.counted_ns = 201 * kMs, .asked_ns = 4 * kMs, .usual_ns = 15'000, .shown_ns = 3 * kMs}),
      198 * kMs);
  // A sleep inside the turn is on that clock, too, and is no computing.
  EXPECT_EQ(UnaccountedSteal({.counted_ns = 201 * kMs,
                              .asked_ns = 4 * kMs,
                              .usual_ns = 15'000,
                              .shown_ns = 900 * kMs}),
            197 * kMs);
}

}  // namespace
}  // namespace tcs
