#include "coordinator/policy/pacer.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr std::int64_t kMs = 1'000'000, kStart = 5'000'000'000;

TEST(PacerTest, WithoutAPaceNobodyWaits) {
  Pacer pacer(0, false);
  EXPECT_EQ(pacer.ToWait(0, kStart), 0);
  EXPECT_EQ(pacer.ToWait(900 * kMs, kStart), 0);
  EXPECT_EQ(pacer.now_ns(), 900 * kMs);
  EXPECT_EQ(pacer.behind_ns(), 0);
}

TEST(PacerTest, AtPaceOneAnActWaitsForItsTimeOnTheWall) {
  Pacer pacer(1, false);
  EXPECT_EQ(pacer.ToWait(0, kStart), 0);
  EXPECT_EQ(pacer.ToWait(10 * kMs, kStart), 10 * kMs);
  EXPECT_EQ(pacer.ToWait(10 * kMs, kStart + 4 * kMs), 6 * kMs);
  EXPECT_EQ(pacer.now_ns(), 4 * kMs);  // which passes while it waits
  EXPECT_EQ(pacer.ToWait(10 * kMs, kStart + 10 * kMs), 0);
  EXPECT_EQ(pacer.now_ns(), 10 * kMs);
}

TEST(PacerTest, AtPaceTwoItWaitsHalfAsLongAndAtAQuarterFourTimes) {
  Pacer twice(2, false), quarter(0.25, false);
  twice.ToWait(0, kStart);
  quarter.ToWait(0, kStart);
  EXPECT_EQ(twice.ToWait(10 * kMs, kStart), 5 * kMs);
  EXPECT_EQ(quarter.ToWait(10 * kMs, kStart), 40 * kMs);
}

TEST(PacerTest, WhatItIsBehindByItMakesUpFor) {
  Pacer pacer(1, false);
  pacer.ToWait(0, kStart);
  EXPECT_EQ(pacer.ToWait(10 * kMs, kStart + 60 * kMs), 0);
  EXPECT_EQ(pacer.behind_ns(), 50 * kMs);
  EXPECT_EQ(pacer.ToWait(62 * kMs, kStart + 65 * kMs), 0);
  EXPECT_EQ(pacer.behind_ns(), 3 * kMs);
  EXPECT_EQ(pacer.ToWait(70 * kMs, kStart + 66 * kMs), 4 * kMs);
  EXPECT_EQ(pacer.account().behind_ns, 5 * kMs);  // between the two asks, and not after
  EXPECT_EQ(pacer.account().most_ns, 50 * kMs);
  EXPECT_EQ(pacer.account().given_up_ns, 0);
}

TEST(PacerTest, WhatIsMoreThanItMakesUpForIsGivenUp) {
  Pacer pacer(1, false);
  pacer.ToWait(0, kStart);
  EXPECT_EQ(pacer.ToWait(10 * kMs, kStart + 2010 * kMs), 0);
  EXPECT_EQ(pacer.behind_ns(), Pacer::kMostMadeUpNs);
  EXPECT_EQ(pacer.account().given_up_ns, 2000 * kMs - Pacer::kMostMadeUpNs);
  EXPECT_EQ(pacer.ToWait(210 * kMs, kStart + 2010 * kMs), 100 * kMs);
}

TEST(PacerTest, ARunThatStartsStandingHasNotDoneEvenWhatHappensAtZero) {
  Pacer pacer(1, true);
  EXPECT_EQ(pacer.ToWait(0, kStart), Pacer::kForEver);
  EXPECT_TRUE(pacer.stands());
  EXPECT_EQ(pacer.now_ns(), 0);
  pacer.GoOn(kStart + 700 * kMs);
  EXPECT_EQ(pacer.ToWait(0, kStart + 700 * kMs), 0);
  EXPECT_EQ(pacer.ToWait(10 * kMs, kStart + 700 * kMs), 10 * kMs);
  EXPECT_EQ(pacer.account().stood_ns, 700 * kMs);
  EXPECT_EQ(pacer.account().behind_ns, 0);
}

TEST(PacerTest, AStepIsExactHoweverFarApartTheActsAre) {
  Pacer pacer(0, true);
  pacer.ToWait(0, kStart);
  pacer.StepBy(100 * kMs, kStart);
  for (std::int64_t next = 0; next <= 100 * kMs; next += 20 * kMs) {
    EXPECT_EQ(pacer.ToWait(next, kStart), 0) << next;
  }
  EXPECT_EQ(pacer.ToWait(120 * kMs, kStart), Pacer::kForEver);
  EXPECT_EQ(pacer.now_ns(), 100 * kMs);
  pacer.StepBy(7 * kMs, kStart);
  EXPECT_EQ(pacer.ToWait(120 * kMs, kStart), Pacer::kForEver);
  EXPECT_EQ(pacer.now_ns(), 107 * kMs);
  pacer.StepBy(13 * kMs, kStart);
  EXPECT_EQ(pacer.ToWait(120 * kMs, kStart), 0);
  EXPECT_EQ(pacer.ToWait(120 * kMs + 1, kStart), Pacer::kForEver);
  EXPECT_EQ(pacer.now_ns(), 120 * kMs);
}

TEST(PacerTest, OfStepsThatAreAskedForAtOnceEachCounts) {
  Pacer pacer(0, true);
  pacer.ToWait(0, kStart);
  pacer.StepBy(10 * kMs, kStart);
  pacer.StepBy(10 * kMs, kStart);
  EXPECT_EQ(pacer.ToWait(20 * kMs, kStart), 0);
  EXPECT_EQ(pacer.ToWait(21 * kMs, kStart), Pacer::kForEver);
}

TEST(PacerTest, AStepHasThePaceOfTheRun) {
  Pacer pacer(0.5, true);
  pacer.ToWait(0, kStart);
  pacer.StepBy(10 * kMs, kStart + 3 * kMs);
  EXPECT_EQ(pacer.ToWait(0, kStart + 3 * kMs), 0);
  // Nothing is due before the step's end, which is waited for all the same.
  EXPECT_EQ(pacer.ToWait(50 * kMs, kStart + 3 * kMs), 20 * kMs);
  EXPECT_FALSE(pacer.stands());
  EXPECT_EQ(pacer.ToWait(50 * kMs, kStart + 23 * kMs), Pacer::kForEver);
  EXPECT_EQ(pacer.now_ns(), 10 * kMs);
}

TEST(PacerTest, ARunStandsWhereItHasCometo) {
  Pacer pacer(1, false);
  pacer.ToWait(0, kStart);
  EXPECT_EQ(pacer.ToWait(50 * kMs, kStart + 30 * kMs), 20 * kMs);
  pacer.Stand(kStart + 31 * kMs);
  EXPECT_EQ(pacer.ToWait(50 * kMs, kStart + 31 * kMs), Pacer::kForEver);
  EXPECT_EQ(pacer.now_ns(), 30 * kMs);
  // What still happens at that time does.
  EXPECT_EQ(pacer.ToWait(30 * kMs, kStart + 40 * kMs), 0);
  pacer.ToWait(50 * kMs, kStart + 41 * kMs);
  pacer.GoOn(kStart + 1041 * kMs);
  EXPECT_EQ(pacer.ToWait(50 * kMs, kStart + 1041 * kMs), 20 * kMs);
  EXPECT_EQ(pacer.account().given_up_ns, 0);
}

TEST(PacerTest, AnotherPaceCountsFromNow) {
  Pacer pacer(1, false);
  pacer.ToWait(0, kStart);
  pacer.ToWait(100 * kMs, kStart + 100 * kMs);
  pacer.SetPace(0.1, kStart + 100 * kMs);
  EXPECT_EQ(pacer.ToWait(110 * kMs, kStart + 100 * kMs), 100 * kMs);
  pacer.SetPace(0, kStart + 101 * kMs);
  EXPECT_EQ(pacer.ToWait(900 * kMs, kStart + 101 * kMs), 0);
}

TEST(PacerTest, StandingDoesNotUndoWhatAStepHasLeft) {
  Pacer pacer(1, true);
  pacer.ToWait(0, kStart);
  pacer.StepBy(100 * kMs, kStart);
  pacer.ToWait(0, kStart);
  pacer.ToWait(90 * kMs, kStart + 40 * kMs);
  pacer.Stand(kStart + 40 * kMs);  // in the middle of the step
  EXPECT_EQ(pacer.ToWait(90 * kMs, kStart + 41 * kMs), Pacer::kForEver);
  EXPECT_EQ(pacer.now_ns(), 40 * kMs);
}

}  // namespace
}  // namespace tcs
