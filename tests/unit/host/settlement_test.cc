#include "coordinator/host/settlement.h"

#include <gtest/gtest.h>

#include <string>

namespace tcs {
namespace {

constexpr std::int64_t kMs = 1'000'000, kUs = 1'000;

struct Case {
  std::string name;
  StoppedRun run;
  Settlement settled;
};

class SettleRunTest : public testing::TestWithParam<Case> {};

TEST_P(SettleRunTest, ComesTo) {
  const Settlement settled = SettleRun(GetParam().run);
  EXPECT_EQ(settled.progress_ns, GetParam().settled.progress_ns);
  EXPECT_EQ(settled.debt_ns, GetParam().settled.debt_ns);
  EXPECT_EQ(settled.ours_ns, GetParam().settled.ours_ns);
}

INSTANTIATE_TEST_SUITE_P(
    Runs, SettleRunTest,
    testing::Values(
        Case{"ItStopsWhereItsClockIs",
             {.start_ns = 5 * kMs, .horizon_ns = 9 * kMs, .reached_ns = 7 * kMs},
             {.progress_ns = 7 * kMs}},
        Case{"WhatItExecutedBeyondItsHorizonIsADebt",
             {.start_ns = 5 * kMs,
              .horizon_ns = 6 * kMs,
              .reached_ns = 6 * kMs + 30 * kUs,
              .is_preempted = true},
             {.progress_ns = 6 * kMs, .debt_ns = 30 * kUs}},
        Case{"JustBeforeItsHorizonATimersRestIsCredit",
             {.start_ns = 5 * kMs,
              .horizon_ns = 6 * kMs,
              .reached_ns = 6 * kMs - kCreditNs,
              .is_preempted = true},
             {.progress_ns = 6 * kMs, .debt_ns = -kCreditNs}},
        Case{"LongBeforeItsHorizonItIsNot",
             {.start_ns = 5 * kMs,
              .horizon_ns = 6 * kMs,
              .reached_ns = 6 * kMs - kCreditNs - 1,
              .is_preempted = true},
             {.progress_ns = 6 * kMs - kCreditNs - 1}},
        Case{"WhoStopsByItselfGetsNoCredit",
             {.start_ns = 5 * kMs,
              .horizon_ns = 6 * kMs,
              .reached_ns = 6 * kMs - 1,
              .noted_ns = 6 * kMs - 1},
             {.progress_ns = 6 * kMs - 1}},
        Case{"ANotificationIsNeitherItsTimeNorItsCharge",
             {.start_ns = 5 * kMs,
              .horizon_ns = 9 * kMs,
              .reached_ns = 7 * kMs + 8 * kUs,
              .noted_ns = 7 * kMs},
             {.progress_ns = 7 * kMs, .ours_ns = 8 * kUs}},
        Case{"NorIsMoreThanTheWholeRun",
             {.start_ns = 5 * kMs,
              .horizon_ns = 9 * kMs,
              .reached_ns = 5 * kMs + 8 * kUs,
              .noted_ns = 3 * kMs},
             {.progress_ns = 5 * kMs, .ours_ns = 8 * kUs}},
        Case{"ANotificationInTheFutureTakesNothing",
             {.start_ns = 5 * kMs,
              .horizon_ns = 9 * kMs,
              .reached_ns = 7 * kMs,
              .noted_ns = 8 * kMs},
             {.progress_ns = 7 * kMs}},
        Case{"AtTheHorizonTheNotificationIsADebtAsAllIs",
             {.start_ns = 5 * kMs,
              .horizon_ns = 6 * kMs,
              .reached_ns = 6 * kMs + 8 * kUs,
              .noted_ns = 6 * kMs},
             {.progress_ns = 6 * kMs, .debt_ns = 8 * kUs}},
        Case{"AYieldIsCharged",
             {.start_ns = 5 * kMs, .horizon_ns = 9 * kMs, .reached_ns = 7 * kMs + 8 * kUs},
             {.progress_ns = 7 * kMs + 8 * kUs}},
        Case{"WhatItsClockHasShownHasHappened",
             {.start_ns = 5 * kMs,
              .horizon_ns = 9 * kMs,
              .reached_ns = 7 * kMs - 50 * kUs,
              .shown_ns = 7 * kMs},
             {.progress_ns = 7 * kMs, .debt_ns = -50 * kUs}},
        Case{"ButNotBeyondItsHorizon",
             {.start_ns = 5 * kMs,
              .horizon_ns = 6 * kMs,
              .reached_ns = 6 * kMs,
              .shown_ns = 7 * kMs},
             {.progress_ns = 6 * kMs}},
        Case{"MoreCreditThanErrorsMakeIsNone",
             {.start_ns = 5 * kMs,
              .horizon_ns = 9 * kMs,
              .reached_ns = 7 * kMs - kMostCreditNs - 1,
              .shown_ns = 7 * kMs},
             {.progress_ns = 7 * kMs}},
        Case{"ButForWhatTheRunBeganWith",
             {.start_ns = 5 * kMs,
              .horizon_ns = 9 * kMs,
              .reached_ns = 4 * kMs,
              .shown_ns = 5 * kMs,
              .credit_ns = 2 * kMs},
             {.progress_ns = 5 * kMs, .debt_ns = -1 * kMs}},
        Case{"AVirtualCpuNeverGoesBack",
             {.start_ns = 5 * kMs, .horizon_ns = 4 * kMs, .reached_ns = 5 * kMs + 70 * kUs},
             {.progress_ns = 5 * kMs, .debt_ns = 70 * kUs}},
        Case{"NorByCreditForWhatTheRunBeginsWith",
             {.start_ns = 5 * kMs,
              .horizon_ns = 9 * kMs,
              .reached_ns = 5 * kMs - 3 * kUs,
              .shown_ns = 5 * kMs},
             {.progress_ns = 5 * kMs, .debt_ns = -3 * kUs}}),
    [](const testing::TestParamInfo<Case>& one) { return one.param.name; });

TEST(IsAtHorizon, IsSoAShortTimeBefore) {
  EXPECT_FALSE(IsAtHorizon(kMs - kCreditNs - 1, kMs));
  EXPECT_TRUE(IsAtHorizon(kMs - kCreditNs, kMs));
  EXPECT_TRUE(IsAtHorizon(2 * kMs, kMs));
}

}  // namespace
}  // namespace tcs
