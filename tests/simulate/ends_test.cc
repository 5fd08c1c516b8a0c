// Processes that end or misbehave beside others, and the world.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "libtcs_preload/exchange.h"
#include "tests/simulate/stage.h"

namespace tcs::simulate {
namespace {

class EngineEnds : public Stage {};

TEST_F(EngineEnds, AProcessThatSpeaksNonsenseIsEndedAndNobodyElse) {
  Begin({.count = 2});
  bool goes_on = false, is_done = false;
  const Task& task = Add({}, [&] {
    preload::Entered guest;
    preload::Exchange(*guest.thread(), {.kind = static_cast<shm::NotificationKind>(200)});
    goes_on = true;
  });
  Add({.robot = 1}, [&] {
    SleepUntil(20 * kMs);
    is_done = true;
  });
  ASSERT_TRUE(StepUntil([&] { return is_done; }));
  EXPECT_EQ(task.state, TaskState::kDead);
  EXPECT_FALSE(goes_on);
  ASSERT_EQ(run().report.warnings.size(), 1u);
  EXPECT_NE(run().report.warnings[0].find("robot0"), std::string::npos);
}

TEST_F(EngineEnds, TheThreadsOfAProcessThatDiesAreMissedAtOnce) {
  Begin({.count = 2}, false);
  std::int64_t other_ns = 0;
  const Task& one = Add({}, [] { Compute(kSecond); });
  const Task& beside = AddBeside([] { SleepUntil(kSecond); });
  Add({.robot = 1}, [&] {
    Compute(20 * kMs);
    other_ns = ReadClock();
  });
  ASSERT_TRUE(StepUntil([&] { return one.charged > VirtualNs(5 * kMs); }));
  kernel().Kill(one.process->pid);
  ASSERT_TRUE(StepUntil([&] { return other_ns != 0; }));
  EXPECT_EQ(one.state, TaskState::kDead);
  EXPECT_EQ(beside.state, TaskState::kDead);
  EXPECT_NEAR(static_cast<double>(other_ns), 20.0 * kMs, 0.5 * kMs);
  EXPECT_LT(one.charged, VirtualNs(10 * kMs));
}

TEST_F(EngineEnds, TheWorldStaysAsNearAsTheDriftBoundSays) {
  Begin({.has_world = true}, false);
  bool is_done = false;
  Add({}, [&] {
    for (int i = 0; i < 10; ++i) {
      Compute(3 * kMs);
      SleepUntil(ReadClock() + 2 * kMs);
    }
    is_done = true;
  });
  VirtualDuration most;
  ASSERT_TRUE(StepUntil([&] {
    most = std::max(most, run().root.drift());
    return is_done;
  }));
  EXPECT_LE(most, VirtualNs(kMs));
  EXPECT_GE(all().world.progress(), VirtualTime() + VirtualNs(48 * kMs));
}

}  // namespace
}  // namespace tcs::simulate
