#include "coordinator/host/active_threads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/host/noting_executor.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class ActiveThreadsTest : public testing::Test {
 protected:
  // A dispatch, after which the thread stops by priority, or at its gate.
  void Run(HostThread& thread, bool ends_at_gate) {
    active_.Dispatch(thread);
    thread.parked = ends_at_gate;
  }

  NotingExecutor executor_;
  ActiveThreads active_{executor_};
  HostThread one_{.tid = 1}, two_{.tid = 2}, three_{.tid = 3};
};

TEST_F(ActiveThreadsTest, TheDispatchedOneRunsAndThePreemptedOneIsHeld) {
  Run(one_, false);
  EXPECT_THAT(executor_.Told(), ElementsAre("run 1"));
  Run(two_, false);
  EXPECT_THAT(executor_.Told(), ElementsAre("hold 1", "run 2"));
}

TEST_F(ActiveThreadsTest, WhoIsDispatchedAgainCostsNothing) {
  Run(one_, false);
  executor_.Told();
  Run(one_, false);
  EXPECT_THAT(executor_.Told(), IsEmpty());
}

TEST_F(ActiveThreadsTest, TwoThatTakeTurnsAtTheirGatesCostNothing) {
  Run(one_, true);
  Run(two_, true);
  EXPECT_THAT(executor_.Told(), ElementsAre("run 1", "run 2"));
  Run(one_, true);
  Run(two_, true);
  EXPECT_THAT(executor_.Told(), IsEmpty());
}

TEST_F(ActiveThreadsTest, WhoIsHeldAlreadyIsNotHeldAgain) {
  active_.Hold(one_);
  EXPECT_THAT(executor_.Told(), IsEmpty());
  Run(one_, false);
  active_.Hold(one_);
  executor_.Told();
  active_.Hold(one_);
  Run(two_, false);
  EXPECT_THAT(executor_.Told(), ElementsAre("run 2"));
}

TEST_F(ActiveThreadsTest, OfANewOneNobodyKnowsWhatItMay) {
  active_.HoldUnknown(one_);
  EXPECT_THAT(executor_.Told(), ElementsAre("hold 1"));
}

TEST_F(ActiveThreadsTest, WhatIsLentIsTakenBack) {
  Run(one_, false);
  executor_.Told();
  active_.Lend(two_);
  EXPECT_TRUE(active_.is_lent());
  EXPECT_THAT(executor_.Told(), ElementsAre("run 2"));
  active_.Lend(three_);
  EXPECT_THAT(executor_.Told(), ElementsAre("hold 2", "run 3"));
  active_.TakeBack();
  EXPECT_FALSE(active_.is_lent());
  EXPECT_THAT(executor_.Told(), ElementsAre("hold 3"));
  active_.TakeBack();
  EXPECT_THAT(executor_.Told(), IsEmpty());
}

TEST_F(ActiveThreadsTest, NothingIsSaidOfAThreadThatHasEnded) {
  Run(one_, false);
  active_.Lend(two_);
  active_.Ended(one_);
  active_.Ended(two_);
  executor_.Told();
  EXPECT_FALSE(active_.is_lent());
  EXPECT_FALSE(active_.IsLast(one_));
  active_.TakeBack();
  Run(three_, false);
  EXPECT_THAT(executor_.Told(), ElementsAre("run 3"));
}

TEST_F(ActiveThreadsTest, WhoHasToEndRunsBesideTheDispatchedOne) {
  Run(one_, false);
  active_.LetRun(two_);
  EXPECT_THAT(executor_.Told(), ElementsAre("run 1", "run 2"));
  EXPECT_TRUE(active_.IsLast(one_));
}

TEST_F(ActiveThreadsTest, WhomTheKernelHasFinishedWithIsHeld) {
  Run(one_, false);
  executor_.Told();
  active_.LetKernelFinish(one_);
  EXPECT_THAT(executor_.Told(), ElementsAre("finish 1"));
  EXPECT_FALSE(one_.may_run);
  Run(one_, false);
  EXPECT_THAT(executor_.Told(), ElementsAre("run 1"));
}

}  // namespace
}  // namespace tcs
