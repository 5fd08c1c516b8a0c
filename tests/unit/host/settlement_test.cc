#include "coordinator/host/settlement.h"

#include <gtest/gtest.h>

#include <string>

// Its kMs is of virtual time, that of other tests here a count of nanoseconds.
namespace tcs::settlement {
namespace {

constexpr VirtualDuration kMs = VirtualDuration::Milliseconds(1),
                          kUs = VirtualDuration::Microseconds(1), kNs = VirtualNs(1);

constexpr VirtualTime At(VirtualDuration since_start) { return VirtualTime() + since_start; }

struct Case {
  std::string name;
  StoppedRun run;
  Settlement settled;
};

class SettleRunTest : public testing::TestWithParam<Case> {};

TEST_P(SettleRunTest, ComesTo) {
  const Settlement settled = SettleRun(GetParam().run);
  EXPECT_EQ(settled.progress, GetParam().settled.progress);
  EXPECT_EQ(settled.debt, GetParam().settled.debt);
  EXPECT_EQ(settled.exchange_overhead, GetParam().settled.exchange_overhead);
}

INSTANTIATE_TEST_SUITE_P(
    Runs, SettleRunTest,
    testing::Values(
        Case{"ItStopsWhereItsClockIs",
             {.start = At(5 * kMs), .horizon = At(9 * kMs), .reached = At(7 * kMs)},
             {.progress = At(7 * kMs)}},
        Case{"WhatItExecutedBeyondItsHorizonIsADebt",
             {.start = At(5 * kMs),
              .horizon = At(6 * kMs),
              .reached = At(6 * kMs + 30 * kUs),
              .is_preempted = true},
             {.progress = At(6 * kMs), .debt = 30 * kUs}},
        Case{"JustBeforeItsHorizonATimersRestIsCredit",
             {.start = At(5 * kMs),
              .horizon = At(6 * kMs),
              .reached = At(6 * kMs - kCredit),
              .is_preempted = true},
             {.progress = At(6 * kMs), .debt = -kCredit}},
        Case{"LongBeforeItsHorizonItIsNot",
             {.start = At(5 * kMs),
              .horizon = At(6 * kMs),
              .reached = At(6 * kMs - kCredit - kNs),
              .is_preempted = true},
             {.progress = At(6 * kMs - kCredit - kNs)}},
        Case{"WhoStopsByItselfGetsNoCredit",
             {.start = At(5 * kMs),
              .horizon = At(6 * kMs),
              .reached = At(6 * kMs - kNs),
              .noted = At(6 * kMs - kNs)},
             {.progress = At(6 * kMs - kNs)}},
        Case{"ANotificationIsNeitherItsTimeNorItsCharge",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(7 * kMs + 8 * kUs),
              .noted = At(7 * kMs)},
             {.progress = At(7 * kMs), .exchange_overhead = 8 * kUs}},
        Case{"NorIsMoreThanTheWholeRun",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(5 * kMs + 8 * kUs),
              .noted = At(3 * kMs)},
             {.progress = At(5 * kMs), .exchange_overhead = 8 * kUs}},
        Case{"WhatIsMoreThanANotificationTakesIsNot",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(8 * kMs),
              .noted = At(3 * kMs)},
             {.progress = At(8 * kMs - 50 * kUs), .exchange_overhead = 50 * kUs}},
        Case{"ButNotWhatAnEarlierTurnOwes",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(5 * kMs + 9 * kUs),
              .noted = At(5 * kMs),
              .credit = -1 * kUs},
             {.progress = At(5 * kMs + 1 * kUs), .exchange_overhead = 8 * kUs}},
        Case{"ANotificationInTheFutureTakesNothing",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(7 * kMs),
              .noted = At(8 * kMs)},
             {.progress = At(7 * kMs)}},
        Case{"AtTheHorizonTheNotificationIsADebtAsAllIs",
             {.start = At(5 * kMs),
              .horizon = At(6 * kMs),
              .reached = At(6 * kMs + 8 * kUs),
              .noted = At(6 * kMs)},
             {.progress = At(6 * kMs), .debt = 8 * kUs}},
        Case{"AYieldIsCharged",
             {.start = At(5 * kMs), .horizon = At(9 * kMs), .reached = At(7 * kMs + 8 * kUs)},
             {.progress = At(7 * kMs + 8 * kUs)}},
        Case{"WhatItsClockHasShownHasHappened",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(7 * kMs - 50 * kUs),
              .shown = At(7 * kMs)},
             {.progress = At(7 * kMs), .debt = -50 * kUs}},
        Case{"ButNotBeyondItsHorizon",
             {.start = At(5 * kMs),
              .horizon = At(6 * kMs),
              .reached = At(6 * kMs),
              .shown = At(7 * kMs)},
             {.progress = At(6 * kMs)}},
        Case{"MoreCreditThanErrorsMakeIsNone",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(7 * kMs - kMostCredit - kNs),
              .shown = At(7 * kMs)},
             {.progress = At(7 * kMs)}},
        Case{"ButForWhatTheRunBeganWith",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(4 * kMs),
              .shown = At(5 * kMs),
              .credit = 2 * kMs},
             {.progress = At(5 * kMs), .debt = -kMs}},
        Case{"AVirtualCpuNeverGoesBack",
             {.start = At(5 * kMs), .horizon = At(4 * kMs), .reached = At(5 * kMs + 70 * kUs)},
             {.progress = At(5 * kMs), .debt = 70 * kUs}},
        Case{"NorByCreditForWhatTheRunBeginsWith",
             {.start = At(5 * kMs),
              .horizon = At(9 * kMs),
              .reached = At(5 * kMs - 3 * kUs),
              .shown = At(5 * kMs)},
             {.progress = At(5 * kMs), .debt = -3 * kUs}}),
    [](const testing::TestParamInfo<Case>& one) { return one.param.name; });

TEST(IsAtHorizon, IsSoAShortTimeBefore) {
  EXPECT_FALSE(IsAtHorizon(At(kMs - kCredit - kNs), At({}), At(kMs), false));
  EXPECT_TRUE(IsAtHorizon(At(kMs - kCredit), At({}), At(kMs), false));
  EXPECT_TRUE(IsAtHorizon(At(2 * kMs), At({}), At(kMs), false));
}

TEST(IsAtHorizon, IsSoAfterMostOfAShortTurn) {
  EXPECT_FALSE(IsAtHorizon(At(kMs - kCredit / 4 - kNs), At(kMs - kCredit), At(kMs), true));
  EXPECT_TRUE(IsAtHorizon(At(kMs - kCredit / 4), At(kMs - kCredit), At(kMs), true));
}

}  // namespace
}  // namespace tcs::settlement
