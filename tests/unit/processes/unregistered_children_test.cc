#include "coordinator/processes/unregistered_children.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <vector>

namespace tcs {
namespace {

// This process is the parent, and has a child that waits for ever.
class UnregisteredChildrenTest : public testing::Test {
 protected:
  void SetUp() override {
    child_ = fork();
    if (child_ == 0) {
      for (;;) pause();
    }
    reactor_.On(Tag::kUnregisteredChild, [this](const Subject& child, std::uint32_t, EventTime) {
      ended_.push_back(static_cast<pid_t>(child.index));
      parents_.push_back(children_.Ended(ended_.back()));
      return PollOutcome{};
    });
    parent_ = &run_.table.AddProcess(getpid());
  }
  void TearDown() override {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  void EndChild() {
    kill(child_, SIGKILL);
    if (reactor_.Wait(HostDuration::Seconds(100)) > 0) reactor_.Handle({});
  }

  pid_t child_ = -1;
  RunState run_{Scenario{}, RunOptions{}, false};
  Reactor reactor_;
  UnregisteredThreads unregistered_{run_};
  UnregisteredChildren children_{run_.table, reactor_, unregistered_};
  std::vector<pid_t> ended_;
  std::vector<Process*> parents_;
  Process* parent_ = nullptr;
};

TEST_F(UnregisteredChildrenTest, AChildThatNobodyAnnouncedIsFoundAndItsEndSeen) {
  EXPECT_FALSE(children_.AnyCounts());
  children_.LookFor(*parent_);
  EXPECT_TRUE(children_.living().contains(child_));
  EXPECT_TRUE(children_.AreOf(*parent_));
  EXPECT_TRUE(children_.AnyCounts());
  EndChild();
  EXPECT_EQ(ended_, std::vector<pid_t>{child_});
  EXPECT_EQ(parents_, std::vector<Process*>{parent_});
  EXPECT_FALSE(children_.AreOf(*parent_));
}

TEST_F(UnregisteredChildrenTest, OneThatHasEndedAndWasNotWaitedForIsNotFoundAgain) {
  children_.LookFor(*parent_);
  EndChild();
  children_.LookFor(*parent_);
  EXPECT_TRUE(children_.living().empty());
}

TEST_F(UnregisteredChildrenTest, AnnouncedOnesAreNone) {
  run_.table.AddProcess(child_);
  children_.LookFor(*parent_);
  EXPECT_TRUE(children_.living().empty());
}

}  // namespace
}  // namespace tcs
