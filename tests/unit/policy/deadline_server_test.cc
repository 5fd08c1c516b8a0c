// Which deadline and how much budget a thread of SCHED_DEADLINE has when it wakes, and after it
// ran.
#include "coordinator/policy/deadline_server.h"

#include <gtest/gtest.h>

#include <ostream>

namespace tcs {
namespace {

// It began at 0 and has run for `spent`, when it wakes at `woken`.
struct ServerCase {
  const char* name;
  DeadlineParameters parameters;
  std::int64_t spent_ns, woken_ns;
  std::int64_t deadline_ns, budget_ns, throttled_until_ns;
};

std::ostream& operator<<(std::ostream& out, const ServerCase& test) { return out << test.name; }

class DeadlineServerTest : public testing::TestWithParam<ServerCase> {};

TEST_P(DeadlineServerTest, HasADeadlineAndABudgetWhenItWakes) {
  const ServerCase& test = GetParam();
  DeadlineServer server;
  server.Start(test.parameters, 0);
  server.Spend(test.spent_ns, test.spent_ns);
  EXPECT_EQ(server.DeadlineIfWoken(test.woken_ns), test.deadline_ns);
  server.WakeUp(test.woken_ns);
  EXPECT_EQ(server.deadline_ns(), test.deadline_ns);
  EXPECT_EQ(server.budget_ns(), test.budget_ns);
  EXPECT_EQ(server.throttled_until_ns(), test.throttled_until_ns);
}

constexpr DeadlineParameters kThird{30, 100, 100}, kConstrained{30, 60, 100}, kNoRuntime{0, 100, 0};

const ServerCase kServerCases[] = {
    {"KeepsWhatFits", kThird, 20, 50, 100, 10, 0},
    {"BeginsAnewWhereTooMuchIsLeft", kThird, 10, 50, 150, 30, 0},
    {"BeginsAnewAtItsDeadline", kThird, 20, 100, 200, 30, 0},
    {"BeginsAnewAfterItsDeadline", kThird, 20, 170, 270, 30, 0},
    {"HasTheNextPeriodsOnceItIsUsedUp", kThird, 30, 40, 200, 30, 100},
    {"BeginsAnewAfterItsThrottling", kThird, 30, 110, 210, 30, 0},
    {"PaysForWhatItHadTooMuch", kThird, 35, 40, 200, 25, 100},
    {"ConstrainedKeepsWhatFits", kConstrained, 25, 45, 60, 5, 0},
    {"ConstrainedGetsWhatIsItsDue", kConstrained, 10, 40, 60, 10, 0},
    {"ConstrainedWaitsForItsPeriod", kConstrained, 10, 70, 160, 30, 100},
    {"ConstrainedBeginsAnewInItsPeriod", kConstrained, 10, 120, 180, 30, 0},
    {"WithoutARuntimeEachReleaseBeginsAnew", kNoRuntime, 70, 80, 180, INT64_MAX, 0},
};

INSTANTIATE_TEST_SUITE_P(Which, DeadlineServerTest, testing::ValuesIn(kServerCases),
                         testing::PrintToStringParamName());

TEST(DeadlineServer, WhoGivesUpIsThrottledUntilItsNextPeriod) {
  DeadlineServer server;
  server.Start(kThird, 0);
  server.GiveUp(5);
  EXPECT_EQ(server.throttled_until_ns(), 100);
  EXPECT_EQ(server.deadline_ns(), 200);
  EXPECT_EQ(server.budget_ns(), 30);
  server.GiveUp(5);
  EXPECT_EQ(server.deadline_ns(), 200) << "it has nothing left to give up";
}

TEST(DeadlineServer, WhoIsFarBehindBeginsAnew) {
  DeadlineServer server;
  server.Start(kThird, 0);
  server.Spend(30, 500);
  EXPECT_EQ(server.deadline_ns(), 600);
  EXPECT_EQ(server.budget_ns(), 30);
}

}  // namespace
}  // namespace tcs
