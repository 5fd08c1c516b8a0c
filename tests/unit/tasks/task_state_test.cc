#include "coordinator/tasks/task_state.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr TaskState kAll[] = {TaskState::kStarting, TaskState::kReady,  TaskState::kHolding,
                              TaskState::kWaiting,  TaskState::kUnseen, TaskState::kDead};

TEST(TaskState, WhoeverIsDeadStaysSo) {
  for (const TaskState state : kAll) EXPECT_FALSE(MayFollow(TaskState::kDead, state));
}

TEST(TaskState, WhoeverLivesMayDieOrBecomeReady) {
  for (const TaskState state : kAll) {
    if (state == TaskState::kDead) continue;
    EXPECT_TRUE(MayFollow(state, TaskState::kDead));
    EXPECT_TRUE(MayFollow(state, TaskState::kReady));
  }
}

TEST(TaskState, NobodyStartsAgain) {
  for (const TaskState state : kAll) {
    EXPECT_EQ(MayFollow(state, TaskState::kStarting), state == TaskState::kStarting);
  }
}

// A thread that waits or holds does not run, so no call of its can be seen to hold it up.
TEST(TaskState, TheKernelHoldsOnlyWhoeverRuns) {
  for (const TaskState state : kAll) {
    const bool runs = state == TaskState::kReady || state == TaskState::kStarting;
    EXPECT_EQ(MayFollow(state, TaskState::kUnseen), runs);
  }
}

TEST(TaskState, AReadThatHeldIsDispatchedBeforeItHoldsAgain) {
  EXPECT_FALSE(MayFollow(TaskState::kHolding, TaskState::kHolding));
  EXPECT_TRUE(MayFollow(TaskState::kWaiting, TaskState::kHolding));
  EXPECT_TRUE(MayFollow(TaskState::kReady, TaskState::kHolding));
}

}  // namespace
}  // namespace tcs
