#include "coordinator/host/stolen_time.h"

#include <gtest/gtest.h>

#include "tests/unit/host/nanoseconds.h"

namespace tcs {
namespace {

TEST(StolenUntold, NothingIsStolenFromATurnThatEndsBeforeItsTimerIsDue) {
  EXPECT_EQ(StolenUntold({.counted_ns = 3 * kMs, .asked_ns = 4 * kMs, .usual_ns = 15'000}), 0);
}

TEST(StolenUntold, ATimerMayBeLate) {
  EXPECT_EQ(
      StolenUntold(
          {.counted_ns = kMs / 2 + kMostTimerLatenessNs, .asked_ns = kMs / 2, .usual_ns = kMs / 2}),
      0);
}

TEST(StolenUntold, NobodyComputesBeyondTheTimer) {
  EXPECT_EQ(StolenUntold({.counted_ns = 201 * kMs, .asked_ns = 2 * kMs, .usual_ns = 50 * kMs}),
            199 * kMs);
}

TEST(StolenUntold, AThreadOfShortTurnsKeepsItsUsualOne) {
  EXPECT_EQ(StolenUntold({.counted_ns = 201 * kMs, .asked_ns = 4 * kMs, .usual_ns = 15'000}),
            201 * kMs - 15'000);
}

TEST(StolenUntold, WhatItsClockHasShownIsTheThreads) {
  EXPECT_EQ(
      StolenUntold(
          {.counted_ns = 201 * kMs, .asked_ns = 4 * kMs, .usual_ns = 15'000, .shown_ns = 3 * kMs}),
      198 * kMs);
  // A sleep inside the turn is on that clock, too, and is no computing.
  EXPECT_EQ(StolenUntold({.counted_ns = 201 * kMs,
                          .asked_ns = 4 * kMs,
                          .usual_ns = 15'000,
                          .shown_ns = 900 * kMs}),
            197 * kMs);
}

}  // namespace
}  // namespace tcs
