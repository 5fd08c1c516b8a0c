// The engine's parts without a program: what they do with threads that are numbers.
#include <errno.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <memory>
#include <vector>

#include "coordinator/engine/wiring.h"
#include "tests/unit/ready_thread.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

Scenario OfTwoRobots() {
  Scenario scenario;
  scenario.duration = VirtualDuration::Seconds(10);
  scenario.drift_bound = kMs;
  for (const char* name : {"one", "other"}) {
    RobotSpec& spec = scenario.robots.emplace_back();
    spec.name = name;
  }
  return scenario;
}

HostPermits WithLevels(bool permitted) {
  HostPermits permits;
  permits.real_time.error = permitted ? 0 : EPERM;
  return permits;
}

class EngineParts : public testing::Test {
 protected:
  explicit EngineParts(bool has_levels = true)
      : all_{OfTwoRobots(), RunOptions{}, WithLevels(has_levels)} {
    all_.run.header = header_.get();
    all_.setup.Connect();
    all_.setup.MakeRobots();
  }
  Task& AddThread(Robot& robot) {
    const int number = 1'000'000'000 + static_cast<int>(all_.run.table.tasks().size());
    return AddReadyThread(all_.run, all_.waker, robot, number);
  }
  VirtualTime HorizonOf(Task& task) {
    VirtualTime idle_until;
    return all_.horizons.Of(task, &idle_until);
  }

  std::unique_ptr<shm::RunHeader> header_ = std::make_unique<shm::RunHeader>();
  Wiring all_;
  RunState& run_ = all_.run;
};

// Where there are no levels, of a thread that has registered: it has a gate.
class EnginePartsAtGates : public EngineParts {
 protected:
  EnginePartsAtGates() : EngineParts(false) {
    task_ = &AddThread(run_.robots[0]);
    task_->process->link = ProcessLink::Make();
    task_->slot = task_->process->link->TakeSlot(*task_);
    task_->slot_memory = &task_->process->link->SlotAt(task_->slot);
    task_->parked = false;
    run_.turn.Begin(*task_, At(kMs));
  }
  void Says(shm::NotificationKind kind) { SlotOf(*task_).note.kind = kind; }

  Task* task_ = nullptr;
};

// Each virtual CPU, and what comes from outside; there is no network.
TEST_F(EngineParts, AreMadeForEachRobotAndForWhatComesFromOutside) {
  EXPECT_EQ(run_.robots.size(), 2u);
  EXPECT_EQ(run_.cpus.size(), 2u);
  EXPECT_EQ(all_.network_leaf.leaf(), -1);
  EXPECT_GE(all_.outside_leaf.leaf(), 0);
  EXPECT_FALSE(all_.world_leaf.GoesOn());
}

TEST_F(EngineParts, ARunOfNobodyEndsAtItsFirstStep) {
  EXPECT_FALSE(all_.loop.Step());
  EXPECT_FALSE(all_.loop.reached_end());
}

TEST_F(EngineParts, NoThreadRunsFurtherFromTheSlowestThanTheDriftBound) {
  Task& task = AddThread(run_.robots[0]);
  AddThread(run_.robots[1]);
  EXPECT_EQ(HorizonOf(task), At(kMs));
}

TEST_F(EngineParts, AThreadWithoutOthersRunsAsFarAsAClockPageTells) {
  Task& task = AddThread(run_.robots[0]);
  EXPECT_GT(HorizonOf(task), At(kMs));
}

TEST_F(EngineParts, TheRunHasComeAsFarAsItsFurthestCpu) {
  run_.cpus[1].ComeTo(At(VirtualNs(700)));
  EXPECT_EQ(all_.world_leaf.FurthestOfRun(), At(VirtualNs(700)));
}

TEST_F(EngineParts, AThreadThatTheKernelGivesBackIsReadyAtThatTime) {
  Task& task = AddThread(run_.robots[0]);
  all_.waker.SetState(task, TaskState::kUnseen);
  all_.unseen_threads.ComeBack(task, {At(VirtualNs(500))});
  EXPECT_EQ(task.state, TaskState::kReady);
  EXPECT_EQ(task.reached, At(VirtualNs(500)));
}

TEST_F(EngineParts, ASpinnerThatHasSpokenDoesNotStepAside) {
  Task& task = AddThread(run_.robots[0]);
  run_.turn.Begin(task, At(kMs));
  run_.turn.notified = task.spins = true;
  all_.spinners.StepAside(task);
  EXPECT_FALSE(task.spins);
  EXPECT_FALSE(all_.spinners.any());
}

TEST_F(EngineParts, ASpinnerLooksAgainOnceSomebodyHasRun) {
  Task& task = AddThread(run_.robots[0]);
  run_.turn.Begin(task, At(kMs));
  task.spins = true;
  all_.spinners.StepAside(task);
  EXPECT_TRUE(all_.spinners.any());
  EXPECT_EQ(task.state, TaskState::kWaiting);
  all_.spinners.Wake();
  EXPECT_FALSE(all_.spinners.any());
  EXPECT_EQ(task.state, TaskState::kReady);
}

TEST_F(EngineParts, NoGateOpensBeforeACallHasBegun) {
  all_.gate_keeper.TurnBegins();
  EXPECT_FALSE(all_.gate_keeper.says_call());
  EXPECT_FALSE(all_.gate_keeper.TakesOpening());
}

TEST_F(EngineParts, NothingIsPutOffWhereNothingCameBefore) {
  Task& task = AddThread(run_.robots[0]);
  EXPECT_FALSE(all_.gate_keeper.PutOff(&task, [](EventTime) { return PollOutcome{}; }));
}

TEST_F(EngineParts, AStopSignalIsKeptUntilItIsTaken) {
  sigset_t before;
  pthread_sigmask(SIG_SETMASK, nullptr, &before);
  all_.end_requests.Open(all_.reactor);
  EXPECT_FALSE(all_.end_requests.IsPending());
  EXPECT_FALSE(all_.end_requests.Take(run_));
  kill(getpid(), SIGTERM);
  EXPECT_TRUE(all_.end_requests.IsPending());
  EXPECT_TRUE(all_.end_requests.Take(run_));
  EXPECT_TRUE(run_.stop.asked());
  EXPECT_EQ(run_.stop.signal(), SIGTERM);
  EXPECT_FALSE(all_.end_requests.IsPending());
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST_F(EngineParts, NobodyIsWaitedForWhereNothingIsToCome) {
  EXPECT_EQ(all_.idle_time.Living(), 0);
  EXPECT_TRUE(all_.idle_time.HasJumpedOver());
  EXPECT_FALSE(all_.network_leaf.Step());
  EXPECT_FALSE(all_.outside_leaf.Step());
  EXPECT_FALSE(all_.world_leaf.Step());
  EXPECT_TRUE(all_.pace_keeper.Keep());
}

TEST_F(EngineParts, ALookFindsNothingWhereTheKernelHasNothingToSay) {
  const PollOutcome found = all_.event_pump.Poll(EventPump::kNoWait, {At(kMs)});
  EXPECT_FALSE(found.stops_running || found.wakes_others || found.blocks_running);
}

TEST_F(EngineParts, WithLevelsNothingIsPutOff) {
  Task& task = AddThread(run_.robots[0]);
  Task& other = AddThread(run_.robots[1]);
  run_.turn.Begin(task, At(kMs));
  EXPECT_FALSE(all_.gate_keeper.PutOff(&other, [](EventTime) { return PollOutcome{}; }));
}

// It goes on with the call that it begins.
TEST_F(EnginePartsAtGates, ACallThatConcernsNobodyIsMadeInTheSameTurn) {
  Says(shm::NotificationKind::kCall);
  EXPECT_TRUE(all_.gate_keeper.MayGoOn(*task_));
  EXPECT_TRUE(all_.gate_keeper.says_call());
  EXPECT_FALSE(all_.gate_keeper.EndCall({}).stops_running);
  EXPECT_FALSE(all_.gate_keeper.says_call());
  EXPECT_TRUE(all_.gate_keeper.TakesOpening());
  EXPECT_FALSE(all_.gate_keeper.TakesOpening());
  EXPECT_FALSE(task_->parked);
}

TEST_F(EnginePartsAtGates, ACallBeforeWhichSomebodyHasToRunWaitsAtItsGate) {
  Says(shm::NotificationKind::kCall);
  EXPECT_TRUE(all_.gate_keeper.MayGoOn(*task_));
  EXPECT_TRUE(all_.gate_keeper.EndCall(kConcernsAll).stops_running);
  EXPECT_FALSE(all_.gate_keeper.TakesOpening());
  EXPECT_TRUE(task_->parked);
}

TEST_F(EnginePartsAtGates, WhatIsNoCallEndsTheTurn) {
  Says(shm::NotificationKind::kWaitFds);
  EXPECT_FALSE(all_.gate_keeper.MayGoOn(*task_));
  EXPECT_FALSE(all_.gate_keeper.says_call());
}

TEST_F(EnginePartsAtGates, OneThatWasSentToItsGateDoesNotGoOn) {
  Says(shm::NotificationKind::kCall);
  run_.turn.is_sent_to_gate = true;
  EXPECT_FALSE(all_.gate_keeper.MayGoOn(*task_));
}

// What others do meanwhile happens once the running thread begins its next call, in their order.
TEST_F(EnginePartsAtGates, WhatOthersDoIsPutOffToTheEndOfTheCall) {
  Task& other = AddThread(run_.robots[1]);
  std::vector<int> done;
  for (const int which : {1, 2}) {
    EXPECT_TRUE(all_.gate_keeper.PutOff(&other, [&done, which](EventTime) {
      done.push_back(which);
      return PollOutcome{};
    }));
  }
  EXPECT_FALSE(all_.gate_keeper.PutOff(task_, [](EventTime) { return PollOutcome{}; }));
  EXPECT_TRUE(done.empty());
  Says(shm::NotificationKind::kCall);
  EXPECT_TRUE(all_.gate_keeper.MayGoOn(*task_));
  all_.gate_keeper.EndCall({});
  EXPECT_EQ(done, (std::vector<int>{1, 2}));
}

// A handler may begin to say that it ends a wait whose turn has begun meanwhile.
TEST_F(EnginePartsAtGates, WhatEndsAWaitIsOldOnceTheGateHasOpened) {
  const auto slot = static_cast<std::uint32_t>(task_->slot);
  EXPECT_FALSE(all_.gate_keeper.IsSaidBeforeTurn(*task_, {slot, 1}));
  all_.gate_keeper.OpenGate(*task_);
  EXPECT_TRUE(all_.gate_keeper.IsSaidBeforeTurn(*task_, {slot, 1}));
  EXPECT_FALSE(all_.gate_keeper.IsSaidBeforeTurn(*task_, {slot, 0}));
  EXPECT_FALSE(all_.gate_keeper.IsSaidBeforeTurn(*task_, {slot, 1}));
}

TEST_F(EnginePartsAtGates, ANotificationInThePipeEndsTheTurnOfItsThread) {
  all_.kernel_events.Register();
  all_.reactor.Add(task_->process->link->incoming_fd(), EPOLLIN,
                   {Tag::kPipe, task_->process->index});
  Says(shm::NotificationKind::kWaitFds);
  const shm::PipeMessage message{static_cast<std::uint32_t>(task_->slot), 0};
  ASSERT_EQ(write(task_->process->link->notify_fd(), &message, sizeof message),
            static_cast<ssize_t>(sizeof message));
  const PollOutcome found = all_.event_pump.LookOnce(EventPump::kNoWait, {At(kMs)}, true);
  EXPECT_TRUE(found.stops_running);
  EXPECT_TRUE(run_.turn.notified);
}

// A handler may come before a thread's note was heard, and speaks over it: what the thread had said
// counts all the same.
TEST_F(EnginePartsAtGates, ASleepThatNobodyHasHeardOfEndsByTheHandlerThatSpokeOverIt) {
  run_.turn.End();
  SlotOf(*task_).interrupted = {.kind = shm::NotificationKind::kIdle,
                                .fd_count = 0,
                                .time_ns = 0,
                                .deadline_ns = kMs.ns(),
                                .args = {},
                                .fds = {}};
  Says(shm::NotificationKind::kInterrupted);
  all_.notification_receiver.Handle(*task_);
  EXPECT_EQ(task_->state, TaskState::kReady);
  EXPECT_EQ(task_->reason, shm::WakeReason::kSignal);
  EXPECT_EQ(task_->reply[0], 1);
  EXPECT_EQ(task_->activations, 1);
}

TEST_F(EnginePartsAtGates, AThreadThatDidNotWaitGoesOnAfterTheHandler) {
  run_.turn.End();
  SlotOf(*task_).interrupted.kind = shm::NotificationKind::kHorizon;
  Says(shm::NotificationKind::kInterrupted);
  all_.notification_receiver.Handle(*task_);
  EXPECT_EQ(task_->state, TaskState::kReady);
  EXPECT_EQ(task_->reason, shm::WakeReason::kGo);
  EXPECT_EQ(SlotOf(*task_).note.kind, shm::NotificationKind::kResumed);
}

}  // namespace
}  // namespace tcs
