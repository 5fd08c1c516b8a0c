#include "coordinator/host/ahead_clock.h"

#include <gtest/gtest.h>

#include "tests/unit/host/nanoseconds.h"

namespace tcs {
namespace {

constexpr std::int64_t kAll = 1'000 * kMs;

TEST(AheadClock, WhatOthersMayHaveTakenIsNotCertain) {
  AheadClock clock;
  EXPECT_EQ(clock.computed_ns(), 0);
  clock.Know(1 * kMs, 800 * kUs);
  EXPECT_EQ(clock.computed_ns(), 800 * kUs);
  EXPECT_EQ(clock.MayHaveComputedBy(2 * kMs, kAll), 1'800 * kUs);
}

TEST(AheadClock, NothingIsComputedOnTheWay) {
  const AheadClock clock;
  EXPECT_EQ(clock.MayHaveComputedBy(0, kAll), 0);
  EXPECT_EQ(clock.MayHaveComputedBy(AheadClock::kWayNs, kAll), 0);
  EXPECT_EQ(clock.MayHaveComputedBy(AheadClock::kWayNs + 7 * kUs, kAll), 7 * kUs);
}

TEST(AheadClock, FromWhatIsKnownTheTscCarriesOn) {
  AheadClock clock;
  clock.Know(1 * kMs, 800 * kUs);
  EXPECT_EQ(clock.MayHaveComputedBy(1 * kMs, kAll), 800 * kUs);
  EXPECT_EQ(clock.MayHaveComputedBy(1 * kMs + 50 * kUs, kAll), 850 * kUs);
  EXPECT_EQ(clock.MayHaveComputedBy(900 * kUs, kAll), 800 * kUs)
      << "what is known has been computed";
}

TEST(AheadClock, NobodyComputesMoreThanIsAllowed) {
  AheadClock clock;
  clock.Know(1 * kMs, 800 * kUs);
  EXPECT_EQ(clock.MayHaveComputedBy(2 * kMs, 1 * kMs), 1 * kMs);
  EXPECT_EQ(clock.MayHaveComputedBy(2 * kMs, 700 * kUs), 800 * kUs) << "but what is known has been";
}

TEST(AheadClock, WithoutALookForLongNothingMoreIsComputed) {
  AheadClock clock;
  clock.Know(1 * kMs, 800 * kUs);
  const std::int64_t most = 800 * kUs + AheadClock::kMostUnknownNs;
  EXPECT_EQ(clock.MayHaveComputedBy(1 * kMs + AheadClock::kMostUnknownNs, kAll), most);
  EXPECT_EQ(clock.MayHaveComputedBy(500 * kMs, kAll), most);
}

TEST(AheadClock, WhoseProcessorOthersHaveForLongIsStarved) {
  AheadClock clock;
  EXPECT_FALSE(clock.IsStarvedBy(0));
  clock.Know(20 * kMs, 20 * kMs - AheadClock::kWayNs - AheadClock::kMostTakenNs);
  EXPECT_FALSE(clock.IsStarvedBy(20 * kMs)) << "not more than that";
  clock.Know(20 * kMs, 20 * kMs - AheadClock::kWayNs - AheadClock::kMostTakenNs - 1);
  EXPECT_TRUE(clock.IsStarvedBy(20 * kMs));
  clock.Know(80 * kMs, 61 * kMs);
  EXPECT_FALSE(clock.IsStarvedBy(80 * kMs)) << "less than a part of all";
  clock.Know(80 * kMs, 59 * kMs);
  EXPECT_TRUE(clock.IsStarvedBy(80 * kMs));
}

TEST(AheadClock, WhileItRestsNothingIsComputedNorTaken) {
  AheadClock clock;
  clock.Know(1 * kMs, 1 * kMs);
  clock.Rest();
  EXPECT_TRUE(clock.rests());
  EXPECT_EQ(clock.MayHaveComputedBy(2 * kMs, kAll), 1 * kMs);
  clock.GoOn(41 * kMs);
  EXPECT_FALSE(clock.rests());
  EXPECT_EQ(clock.MayHaveComputedBy(41 * kMs, kAll), 1 * kMs);
  EXPECT_EQ(clock.MayHaveComputedBy(41 * kMs + 7 * kUs, kAll), 1 * kMs + 7 * kUs);
  EXPECT_FALSE(clock.IsStarvedBy(41 * kMs));
  clock.Know(81 * kMs, 20 * kMs);
  EXPECT_TRUE(clock.IsStarvedBy(81 * kMs)) << "what was taken since counts";
}

TEST(AheadClock, SoIsOneThatNobodyLooksAt) {
  AheadClock clock;
  clock.Know(10 * kMs, 10 * kMs);
  EXPECT_FALSE(clock.IsStarvedBy(10 * kMs + AheadClock::kLostNs));
  EXPECT_TRUE(clock.IsStarvedBy(10 * kMs + AheadClock::kLostNs + 1));
}

}  // namespace
}  // namespace tcs
