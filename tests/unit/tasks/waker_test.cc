// How a thread comes to act, to hold and to wait, and at what time: threads that are numbers.
#include "coordinator/tasks/waker.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/unit/ready_thread.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

constexpr VirtualDuration kNone;

Scenario WithDriftBound(VirtualDuration bound) {
  Scenario scenario;
  scenario.drift_bound = bound;
  scenario.duration = VirtualDuration::Seconds(10);
  return scenario;
}

// Two robots of one core, which may be 1 ms apart, with a thread each that is ready at 0.
class WakerTest : public testing::Test {
 protected:
  explicit WakerTest(shm::Sync sync = shm::Sync::kConsistent)
      : run_(WithDriftBound(kMs), RunOptions{.sync = sync}, false),
        activations_(sync == shm::Sync::kCallback) {
    run_.header = header_.get();
    waker_.Tell({.began_by_signal = [](Task&) {},
                 .left = [this](Task&, const Wait&) { ++left_; },
                 .ends_in_trapped_call = [](Task&, shm::WakeReason) {},
                 .deliverer_is_held_up = [](const Process&, EventTime) {}});
    task_ = &AddThread(AddRobot("robot"));
    other_ = &AddThread(AddRobot("other"));
  }
  Robot& AddRobot(const std::string& name) {
    Robot& robot = run_.robots.emplace_back(name, 1.0, RobotScheduler(1, true, [this](int order) {
                                              return waker_.WaitOf(run_.table.At(order));
                                            }));
    VirtualCpu& cpu = run_.cpus.emplace_back();
    cpu.robot = &robot;
    cpu.leaf = run_.root.AddLeaf(static_cast<int>(run_.robots.size()));
    robot.cpus.push_back(&cpu);
    return robot;
  }
  Task& AddThread(Robot& robot) {
    const int number = 1 + static_cast<int>(run_.table.tasks().size());
    return AddReadyThread(run_, waker_, robot, number);
  }
  // The thread's virtual CPU has come to that, and the thread with it.
  void ComeTo(Task& task, VirtualTime time) {
    task.cpu->ComeTo(time);
    task.ComeTo(time);
    waker_.Requeue(task);
    waker_.Refresh(*task.process->robot);
  }
  void Sleep(Task& task, VirtualTime deadline) {
    waker_.Wait(task, {awaited::Time{}, deadline});
    waker_.Refresh(*task.process->robot);
  }
  void Read(Task& task) {
    waker_.Wait(task, {awaited::Queue{}});
    waker_.Refresh(*task.process->robot);
  }

  std::unique_ptr<shm::RunHeader> header_ = std::make_unique<shm::RunHeader>();
  RunState run_;
  Activations activations_;
  Waker waker_{run_, activations_};
  int left_ = 0;
  Task* task_ = nullptr;
  Task* other_ = nullptr;
};

TEST_F(WakerTest, AThreadThatSleepsIsReadyWhenItIsWoken) {
  Sleep(*task_, At(5 * kMs));
  EXPECT_EQ(task_->state, TaskState::kWaiting);
  waker_.Wake(*task_, shm::WakeReason::kDeadline, {.at = At(5 * kMs), .from_outside = true});
  EXPECT_EQ(task_->state, TaskState::kReady);
  EXPECT_EQ(task_->reached, At(5 * kMs));
  EXPECT_EQ(task_->reason, shm::WakeReason::kDeadline);
  EXPECT_EQ(task_->wait, std::nullopt);
  EXPECT_EQ(task_->activations, 1);
  EXPECT_EQ(left_, 1);
  EXPECT_EQ(run_.cpus[0].robot->scheduler.Next(0).thread, task_->order);
}

TEST_F(WakerTest, AWaitIsOverByTimeAtItsDeadlineAndNotBefore) {
  EXPECT_FALSE(waker_.HasRunOut(*task_, At(9 * kMs))) << "it does not wait";
  Sleep(*task_, At(5 * kMs));
  EXPECT_FALSE(waker_.HasRunOut(*task_, At(5 * kMs - kNs)));
  EXPECT_TRUE(waker_.HasRunOut(*task_, At(5 * kMs)));
}

TEST_F(WakerTest, AThreadGoesOnNoEarlierThanItHasCome) {
  task_->ComeTo(At(7 * kMs));
  Sleep(*task_, VirtualTime::Never());
  waker_.Wake(*task_, shm::WakeReason::kGo, {At(5 * kMs)});
  EXPECT_EQ(task_->reached, At(7 * kMs));
}

TEST_F(WakerTest, NobodyIsWokenInThePastOfThoseThatHaveGoneOn) {
  Sleep(*task_, VirtualTime::Never());
  ComeTo(*other_, At(8 * kMs));
  EXPECT_EQ(waker_.EarliestWake(), At(7 * kMs));
  waker_.Wake(*task_, shm::WakeReason::kGo, {At(2 * kMs)});
  EXPECT_EQ(task_->reached, At(7 * kMs));
  EXPECT_EQ(run_.root.Least(), At(7 * kMs));
}

TEST_F(WakerTest, NorInThePastOfTheThreadThatRuns) {
  Sleep(*task_, VirtualTime::Never());
  run_.turn.Begin(*other_, At(9 * kMs));
  other_->cpu->ComeTo(At(6 * kMs));  // which its leaf is not told of yet
  EXPECT_EQ(waker_.EarliestWake(), At(5 * kMs));
  waker_.Wake(*task_, shm::WakeReason::kGo, {At(kMs)});
  EXPECT_EQ(task_->reached, At(5 * kMs));
}

TEST_F(WakerTest, AThreadsTimeGoingBackIsABug) {
  task_->ComeTo(At(3 * kMs));
  task_->ComeTo(At(3 * kMs));
  EXPECT_EQ(task_->reached, At(3 * kMs));
  EXPECT_DEATH(task_->ComeTo(At(3 * kMs - kNs)), "a bug in tcs");
}

TEST_F(WakerTest, WhoWaitedForOthersHoldsUntilItCanMissNothing) {
  Read(*task_);
  waker_.Wake(*task_, shm::WakeReason::kGo, {At(2 * kMs)});
  EXPECT_EQ(task_->state, TaskState::kHolding);
  EXPECT_EQ(task_->hold, shm::NotificationKind::kRead);
  task_->cpu->ComeTo(At(2 * kMs));
  EXPECT_FALSE(waker_.IsSafe(*task_)) << "the other robot may still send something at 0";
  ComeTo(*other_, At(2 * kMs));
  EXPECT_TRUE(waker_.IsSafe(*task_));
}

TEST_F(WakerTest, WhoWritesHoldsUntilItIsTooEarlyForNobody) {
  ComeTo(*task_, At(kMs));
  waker_.Hold(*task_, shm::NotificationKind::kWrite);
  EXPECT_EQ(task_->state, TaskState::kHolding);
  EXPECT_FALSE(waker_.IsSafe(*task_));
  ComeTo(*other_, At(kMs));
  EXPECT_TRUE(waker_.IsSafe(*task_));
}

TEST_F(WakerTest, CreditEndsWithTheActivationAndADebtDoesNot) {
  for (const auto& [before, after] : {std::pair{-3 * kNs, kNone}, {kNone, kNone}, {kMs, kMs}}) {
    Sleep(*task_, VirtualTime::Never());
    task_->debt = before;
    waker_.Wake(*task_, shm::WakeReason::kGo, {});
    EXPECT_EQ(task_->debt, after);
  }
}

TEST_F(WakerTest, WhoIsDeadStaysSo) {
  waker_.SetState(*task_, TaskState::kDead);
  waker_.Wake(*task_, shm::WakeReason::kGo, {At(kMs)});
  EXPECT_EQ(task_->state, TaskState::kDead);
  EXPECT_EQ(task_->reached, VirtualTime());
  EXPECT_DEATH(waker_.SetState(*task_, TaskState::kReady), "a bug in tcs");
}

TEST_F(WakerTest, AStateThatCannotFollowIsABug) {
  waker_.Hold(*task_, shm::NotificationKind::kRead);
  EXPECT_DEATH(waker_.SetState(*task_, TaskState::kUnseen), "a bug in tcs");
  EXPECT_DEATH(waker_.Hold(*task_, shm::NotificationKind::kRead), "a bug in tcs");
}

TEST_F(WakerTest, AWaitAndTheStateBelongTogether) {
  EXPECT_DEATH(waker_.SetState(*task_, TaskState::kWaiting), "a bug in tcs");
  Sleep(*task_, At(kMs));
  EXPECT_DEATH(waker_.SetState(*task_, TaskState::kReady), "a bug in tcs") << "without Leave";
  EXPECT_DEATH(Sleep(*task_, At(kMs)), "a bug in tcs") << "it waits already";
}

// The virtual CPU of the woken thread computes on for another one, and has come further.
TEST_F(WakerTest, ForHowLongAnUrgentThreadHadNoCoreIsItsLateness) {
  Task& planner = AddThread(*task_->process->robot);
  SchedulerOf(*task_).SetParameters(task_->order, {.policy = SCHED_FIFO, .priority = 50},
                                    VirtualTime());
  SchedulerOf(*task_).FindEffectivePriority(task_->order);
  Read(*task_);
  ComeTo(planner, At(3 * kMs));
  ComeTo(*other_, At(3 * kMs));
  waker_.Wake(*task_, shm::WakeReason::kGo, {.at = At(3 * kMs), .from_outside = true});
  EXPECT_EQ(run_.report.lateness_ns, 0) << "the core was there";
  waker_.SetState(*task_, TaskState::kReady);
  Read(*task_);
  ComeTo(planner, At(3 * kMs + 400 * VirtualDuration::Microseconds(1)));
  waker_.Wake(*task_, shm::WakeReason::kGo, {.at = At(3 * kMs), .from_outside = true});
  EXPECT_EQ(run_.report.lateness_ns, 400'000);
}

TEST_F(WakerTest, WhoWaitsForItsTurnIsNotLate) {
  Task& urgent = AddThread(*task_->process->robot);
  SchedulerOf(urgent).SetParameters(urgent.order, {.policy = SCHED_FIFO, .priority = 50},
                                    VirtualTime());
  SchedulerOf(urgent).FindEffectivePriority(urgent.order);
  Read(*task_);
  ComeTo(urgent, At(3 * kMs));
  ComeTo(*other_, At(3 * kMs));
  waker_.Wake(*task_, shm::WakeReason::kGo, {.at = At(2 * kMs), .from_outside = true});
  EXPECT_EQ(run_.report.lateness_ns, 0);
}

TEST_F(WakerTest, ThreadsThatTheKernelHoldsAreCountedForTheirPrograms) {
  waker_.SetState(*task_, TaskState::kUnseen);
  EXPECT_EQ(waker_.unseen(), 1);
  EXPECT_EQ(header_->kernel_waiters.load(), 1u);
  waker_.Wake(*task_, shm::WakeReason::kGo, {At(kMs)});
  EXPECT_EQ(waker_.unseen(), 0);
  EXPECT_EQ(header_->kernel_waiters.load(), 0u);
}

TEST_F(WakerTest, WhatIsSentByTheRunningThreadIsFromWhenItsClockShowedLast) {
  const auto slot = std::make_unique<shm::ThreadSlot>();
  task_->slot_memory = slot.get();
  task_->slot = 0;
  task_->cpu->ComeTo(At(2 * kMs));
  run_.turn.Begin(*task_, At(4 * kMs));
  for (const auto& [shown, written] :
       {std::pair{3 * kMs, 3 * kMs}, {kMs, 2 * kMs}, {9 * kMs, 4 * kMs}}) {
    slot->clock.last_shown_ns.store(shown.ns());
    EXPECT_EQ(run_.WrittenAt(), At(written)) << "within its turn, whatever its page says";
  }
  run_.turn.LimitTo(At(kMs));
  EXPECT_EQ(run_.WrittenAt(), At(2 * kMs));
}

TEST_F(WakerTest, WhatIsComputedOutsideOfATurnIsChargedAtOnceAndPassesLater) {
  task_->metered.speed = 0.5;
  EXPECT_EQ(run_.ChargeAsDebt(*task_, 6 * kMs), HostDuration::Milliseconds(3));
  EXPECT_EQ(task_->charged, 6 * kMs);
  EXPECT_EQ(task_->debt, 6 * kMs);
  EXPECT_EQ(run_.report.client_ns, 3'000'000);
  EXPECT_EQ(task_->reached, VirtualTime());
}

class CallbackWakerTest : public WakerTest {
 protected:
  CallbackWakerTest() : WakerTest(shm::Sync::kCallback) {}
};

TEST_F(CallbackWakerTest, NobodyHoldsAndNobodyIsTooEarly) {
  Read(*task_);
  task_->process->clock.Advance({}, 3 * kMs);
  waker_.Wake(*task_, shm::WakeReason::kGo, {At(2 * kMs)});
  EXPECT_EQ(task_->state, TaskState::kReady);
  EXPECT_EQ(waker_.EarliestWake(), VirtualTime());
  waker_.HoldInCall(*task_, shm::NotificationKind::kWrite);
  EXPECT_EQ(task_->state, TaskState::kReady);
}

TEST_F(CallbackWakerTest, AWaitIsOverOnceItsProgramsClockShowsSo) {
  Sleep(*task_, At(5 * kMs));
  EXPECT_FALSE(waker_.HasRunOut(*task_, At(kMs)));
  task_->process->clock.ComeTo(OwnTime((5 * kMs).ns()));
  EXPECT_TRUE(waker_.HasRunOut(*task_, At(kMs)));
}

}  // namespace
}  // namespace tcs
