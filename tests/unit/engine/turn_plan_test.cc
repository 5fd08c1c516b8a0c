// What is decided of a virtual CPU's next turn: tables, one case a line.
#include "coordinator/engine/turn_plan.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "tests/unit/times.h"

namespace tcs {
namespace {

constexpr VirtualDuration kNone;

// The turn begins at 10 ms.
constexpr VirtualTime kStart = At(10 * kMs);

struct LimitCase {
  const char* name;
  TurnLimits limits;
  VirtualTime limit;
};

std::ostream& operator<<(std::ostream& out, const LimitCase& test) { return out << test.name; }

class TurnLimit : public testing::TestWithParam<LimitCase> {};

TEST_P(TurnLimit, IsTheFirstThingThatStopsTheThread) {
  EXPECT_EQ(LimitOf(GetParam().limits), GetParam().limit);
}

const LimitCase kLimits[] = {
    {"NothingButTheClockPage", {.start = kStart}, FurthestOf(kStart)},
    {"TheDriftBound", {.start = kStart, .apart = At(11 * kMs)}, At(11 * kMs)},
    {"TheDriftBoundEvenBehindTheStart", {.start = kStart, .apart = At(9 * kMs)}, At(9 * kMs)},
    {"ATimerOnProcessorTime", {.start = kStart, .cpu_time = 3 * kMs}, At(13 * kMs)},
    {"NoneOnProcessorTime", {.start = kStart, .apart = At(11 * kMs), .cpu_time = {}}, At(11 * kMs)},
    {"ALaunch", {.start = kStart, .next_launch = At(12 * kMs)}, At(12 * kMs)},
    {"ALaunchThatIsDueLetsNobodyBegin", {.start = kStart, .next_launch = At(2 * kMs)}, kStart},
    {"ATimerThatRests", {.start = kStart, .next_timer_look = At(14 * kMs)}, At(14 * kMs)},
    {"OneThatIsDueWaitsALittle",
     {.start = kStart, .next_timer_look = At(2 * kMs)},
     kStart + 10 * kUs},
    {"TheLeastOfAll",
     {.start = kStart,
      .apart = At(15 * kMs),
      .cpu_time = 4 * kMs,
      .next_launch = At(13 * kMs),
      .next_timer_look = At(12 * kMs)},
     At(12 * kMs)},
};

INSTANTIATE_TEST_SUITE_P(Cases, TurnLimit, testing::ValuesIn(kLimits),
                         [](const testing::TestParamInfo<LimitCase>& one) {
                           return std::string(one.param.name);
                         });

TEST(TurnPlan, AThreadThatMayNotRunGivesWayOnceToOthersOfItsInstant) {
  EXPECT_TRUE(GivesWay(kStart, kStart, kStart, false));
  EXPECT_FALSE(GivesWay(kStart, kStart, kStart, true)) << "it has done so";
  EXPECT_FALSE(GivesWay(kStart, kStart + kNs, kStart, false)) << "it may run";
  EXPECT_FALSE(GivesWay(kStart, kStart, kStart + kNs, false)) << "nobody acts at this instant";
}

TEST(TurnPlan, WhoOwesAllOfItsTurnIsNotDispatched) {
  const VirtualTime horizon = kStart + kMs;
  EXPECT_TRUE(OnlyPays(TaskState::kReady, kStart, kMs, horizon));
  EXPECT_TRUE(OnlyPays(TaskState::kHolding, kStart, 2 * kMs, horizon));
  EXPECT_FALSE(OnlyPays(TaskState::kReady, kStart, kMs - kNs, horizon));
  EXPECT_FALSE(OnlyPays(TaskState::kReady, kStart, kNone, horizon));
  EXPECT_FALSE(OnlyPays(TaskState::kReady, kStart, -kMs, horizon)) << "credit is no debt";
}

// It goes on, to read or to write, at the time that its clock shows.
TEST(TurnPlan, WhoHoldsPaysAllBeforeItGoesOn) {
  const VirtualTime horizon = kStart + kMs;
  EXPECT_TRUE(OnlyPays(TaskState::kHolding, kStart, kNs, horizon));
  EXPECT_FALSE(OnlyPays(TaskState::kHolding, kStart, kNone, horizon));
  EXPECT_FALSE(OnlyPays(TaskState::kHolding, kStart, -kNs, horizon)) << "credit is no debt";
  EXPECT_FALSE(OnlyPays(TaskState::kReady, kStart, kNs, horizon));
}

TEST(TurnPlan, ATurnOfNoLengthIsPaidByNothing) {
  EXPECT_TRUE(OnlyPays(TaskState::kReady, kStart, kNone, kStart));
  EXPECT_FALSE(OnlyPays(TaskState::kReady, kStart, -kNs, kStart)) << "its clock stands before that";
}

TEST(TurnPlan, WhoHasNotRegisteredRunsWhateverItOwes) {
  EXPECT_FALSE(OnlyPays(TaskState::kStarting, kStart, 5 * kMs, kStart + kMs));
}

TEST(TurnPlan, WhoComesToItsHorizonAgainAndAgainComputes) {
  int used_up = 0;
  for (int turn = 1; turn <= Task::kComputes; ++turn) {
    used_up = UsedUpAfter(used_up, kStart, kStart, turn == 2);
    EXPECT_EQ(used_up, turn) << "whether it has also said something or not";
  }
  EXPECT_GE(used_up, Task::kComputes);
  // Stopped early for somebody else, it would have gone on.
  EXPECT_EQ(UsedUpAfter(used_up, kStart - kNs, kStart, false), used_up);
  EXPECT_EQ(UsedUpAfter(used_up, kStart - kNs, kStart, true), 0);
}

struct LeadCase {
  const char* name;
  WorldBeside beside;
  std::optional<VirtualTime> to;
};

std::ostream& operator<<(std::ostream& out, const LeadCase& test) { return out << test.name; }

class WorldLead : public testing::TestWithParam<LeadCase> {};

TEST_P(WorldLead, IsWithinTheDriftBound) {
  const WorldBeside& beside = GetParam().beside;
  const auto to = WhereToLead(beside);
  EXPECT_EQ(to, GetParam().to);
  if (!to.has_value()) return;
  EXPECT_GE(*to, beside.now);
  EXPECT_LE(*to, beside.now + beside.drift_bound);
}

// The virtual CPU is at 10 ms; leaves may be 1 ms apart.
WorldBeside Beside(VirtualDuration world, VirtualDuration horizon, bool computes,
                   VirtualDuration apart = 20 * kMs) {
  return {.now = kStart,
          .world = At(world),
          .horizon = At(horizon),
          .apart = At(apart),
          .drift_bound = kMs,
          .computes = computes};
}

const LeadCase kLeads[] = {
    {"NearEnough", Beside(10 * kMs, 11 * kMs, false), {}},
    {"ItMayLagForAShortTurn", Beside(9 * kMs, 10 * kMs, false), {}},
    {"AndUpToHalfTheBoundOfALongOne", Beside(9 * kMs + 500 * kUs, 15 * kMs, false), {}},
    {"ButNotFurther", Beside(9 * kMs + 499 * kUs, 15 * kMs, false), kStart},
    {"WhereAThreadComputesItLeads", Beside(10 * kMs, 15 * kMs, true), At(11 * kMs)},
    {"ButNotWhereItsTurnIsShort", Beside(10 * kMs, 11 * kMs, true), {}},
    {"NorFurtherThanLeavesMayBeApart", Beside(10 * kMs, 15 * kMs, true, 10 * kMs + 700 * kUs),
     At(10 * kMs + 700 * kUs)},
};

INSTANTIATE_TEST_SUITE_P(Cases, WorldLead, testing::ValuesIn(kLeads),
                         [](const testing::TestParamInfo<LeadCase>& one) {
                           return std::string(one.param.name);
                         });

}  // namespace
}  // namespace tcs
