#include "shm/spin_streak.h"

#include <gtest/gtest.h>

namespace tcs::shm {
namespace {

constexpr std::int64_t kGapNs = 500, kShownNs = 7;
constexpr std::uint32_t kSite = 1;

// After so many pauses, each 40 ns after the one before, the first at `from_ns`.
SpinStreak After(int pauses, std::int64_t from_ns = 1'000) {
  SpinStreak streak{};
  for (int i = 0; i < pauses; ++i) CountPause(streak, kSite, from_ns + 40 * i, kShownNs, kGapNs);
  return streak;
}

TEST(SpinStreak, IsOneAfterSomePausesInARow) {
  SpinStreak streak = After(SpinStreak::kSpins - 1);
  EXPECT_FALSE(IsSpinning(streak, streak.last_ns, kGapNs));
  EXPECT_TRUE(CountPause(streak, kSite, 1'300, kShownNs, kGapNs));
  EXPECT_TRUE(IsSpinning(streak, 1'300 + kGapNs, kGapNs));
  EXPECT_FALSE(IsSpinning(streak, 1'301 + kGapNs, kGapNs));
  EXPECT_EQ(streak.begun_ns, 1'000);
}

TEST(SpinStreak, MayHaveBegun) {
  const SpinStreak streak = After(2);
  EXPECT_TRUE(IsSpinning(streak, streak.last_ns, kGapNs, 1));
  EXPECT_FALSE(IsSpinning(SpinStreak{}, 0, kGapNs, 1));
}

TEST(SpinStreak, BeginsAnewAfterAGapOrElsewhere) {
  SpinStreak late = After(SpinStreak::kSpins);
  EXPECT_FALSE(CountPause(late, kSite, late.last_ns + kGapNs + 1, kShownNs, kGapNs));
  EXPECT_EQ(late.begun_ns, late.last_ns);
  SpinStreak elsewhere = After(SpinStreak::kSpins);
  EXPECT_FALSE(CountPause(elsewhere, kSite + 1, elsewhere.last_ns + 1, kShownNs, kGapNs));
}

TEST(SpinStreak, KnowsWhetherTheClockIsRead) {
  SpinStreak streak = After(2);
  EXPECT_EQ(streak.reads_clock, 0);
  CountPause(streak, kSite, streak.last_ns, kShownNs + 1, kGapNs);
  EXPECT_EQ(streak.reads_clock, 1);
}

TEST(SpinStreak, GoesOnAfterATurn) {
  SpinStreak streak = After(SpinStreak::kSpins);
  GoOnSpinning(streak, 50'000, kShownNs + 1);
  EXPECT_FALSE(IsSpinning(streak, 50'000, kGapNs));
  CountPause(streak, kSite, 50'040, kShownNs + 1, kGapNs);
  EXPECT_TRUE(CountPause(streak, kSite, 50'080, kShownNs + 1, kGapNs));
  EXPECT_EQ(streak.begun_ns, 1'000);
  EXPECT_EQ(streak.reads_clock, 0);
}

// Where they are not to be counted.
TEST(SpinStreak, IsNoneWithoutAGap) {
  SpinStreak streak{};
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(CountPause(streak, kSite, i, kShownNs, 0));
}

}  // namespace
}  // namespace tcs::shm
