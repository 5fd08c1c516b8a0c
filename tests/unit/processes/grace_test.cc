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
  };
  void Add(Living& client, VirtualDuration grace) {
    client.spec.stop_grace = grace;
    client.process = &run_.table.AddProcess(next_pid_);
    client.process->client = client.process;
    client.process->spec = &client.spec;
    run_.table.AddTask(next_pid_++).process = client.process;
  }
  void SetUp() override {
    run_.grace_began = At(10 * kSecond);
    Add(slow_, 3 * kSecond);
    Add(quick_, kSecond);
  }

  pid_t next_pid_ = 1'000'000'000;  // of no process
  Living slow_, quick_;
  RunState run_{Scenario{}, RunOptions{}, false};
  Reactor reactor_;
  UnmanagedThreads unmanaged_{run_};
  UnknownChildren unknown_children_{run_.table, reactor_, unmanaged_};
  Grace grace_{run_, reactor_, unknown_children_, [](Moment) {}};
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

TEST_F(GraceTest, IsOverWhenNoRealTimeIsLeft) {
  EXPECT_FALSE(grace_.IsOver());
  grace_.RanOut();
  EXPECT_TRUE(grace_.IsOver());
  EXPECT_FALSE(grace_.GoOnToNextKill());
}

}  // namespace
}  // namespace tcs
