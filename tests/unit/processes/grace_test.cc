#include "coordinator/processes/grace.h"

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/unit/times.h"

namespace tcs {
namespace {

// Three clients live when the grace begins, at 10 s. No signal is sent: they are no processes.
class GraceTest : public testing::Test {
 protected:
  struct Living {
    ClientSpec spec;
    Process* process = nullptr;
    Task* task = nullptr;
  };
  void Add(Living& client, VirtualDuration grace) {
    client.spec.stop_grace = grace;
    client.process = &run_.table.AddProcess(next_pid_);
    client.process->client = client.process;
    client.process->spec = &client.spec;
    client.process->robot = &robot_;
    client.task = &run_.table.AddTask(next_pid_++);
    client.task->process = client.process;
    robot_.tasks.push_back(client.task);
  }
  void SetUp() override {
    run_.grace_began = At(10 * kSecond);
    Add(slow_, 3 * kSecond);
    Add(quick_, kSecond);
  }

  pid_t next_pid_ = 1'000'000'000;  // of no process
  Living slow_, quick_;
  RunState run_{Scenario{}, RunOptions{}, false};
  Robot& robot_ = run_.robots.emplace_back(
      "robot", 1.0, RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; }));
  Reactor reactor_;
  UnregisteredThreads unregistered_{run_};
  UnregisteredChildren unregistered_children_{run_.table, reactor_, unregistered_};
  Grace grace_{run_, reactor_, unregistered_children_, [](EventTime) {}};
};

TEST_F(GraceTest, TheRunGoesOnFromOneClientsKillToTheNextOnes) {
  ASSERT_TRUE(grace_.GoOnToNextKill());
  EXPECT_EQ(run_.end, At(11 * kSecond));
  quick_.process->killed = true;
  ASSERT_TRUE(grace_.GoOnToNextKill());
  EXPECT_EQ(run_.end, At(13 * kSecond));
  slow_.process->dead = true;
  EXPECT_FALSE(grace_.GoOnToNextKill());
}

TEST_F(GraceTest, OneThatIsStoppedByAKillHasNone) {
  slow_.spec.stop_signal = SIGKILL;
  ASSERT_TRUE(grace_.GoOnToNextKill());
  EXPECT_EQ(run_.end, At(10 * kSecond));
}

// What a thread has computed out of its turns passes without it.
TEST_F(GraceTest, BeginsAfterWhatAThreadOwes) {
  quick_.task->debt = kSecond / 2;
  grace_.Begin();
  ASSERT_TRUE(grace_.GoOnToNextKill());
  EXPECT_EQ(run_.end, At(11 * kSecond + kSecond / 2));
}

// Virtual time has not waited for it; no real time has passed to speak of.
TEST_F(GraceTest, OfOneThatTheKernelHasLastsInRealTimeToo) {
  slow_.process->dead = true;
  grace_.Begin();
  quick_.task->state = TaskState::kUnseen;
  ASSERT_TRUE(grace_.GoOnToNextKill());
  EXPECT_TRUE(grace_.KillOverdue());
  EXPECT_FALSE(quick_.process->killed);
  ASSERT_TRUE(grace_.GoOnToNextKill());
  EXPECT_GT(run_.end, At(11 * kSecond));
  EXPECT_LE(run_.end, At(12 * kSecond));
  // It has come back, and has not ended in what was left.
  quick_.task->state = TaskState::kReady;
  EXPECT_FALSE(grace_.KillOverdue());
  EXPECT_TRUE(quick_.process->killed);
}

TEST_F(GraceTest, IsOverWhenNoRealTimeIsLeft) {
  EXPECT_FALSE(grace_.IsOver());
  grace_.RanOut();
  EXPECT_TRUE(grace_.IsOver());
  EXPECT_FALSE(grace_.GoOnToNextKill());
}

}  // namespace
}  // namespace tcs
