// The engine's parts without a program: what they do with threads that are numbers.
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <memory>

#include "coordinator/engine/wiring.h"
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

class EngineParts : public testing::Test {
 protected:
  EngineParts() {
    all_.run.header = header_.get();
    all_.setup.Connect();
    all_.setup.MakeRobots();
  }
  Task& AddThread(Robot& robot) {
    const int number = 1'000'000'000 + static_cast<int>(all_.run.table.tasks().size());
    Process& process = all_.run.table.AddProcess(number);
    process.robot = &robot;
    process.client = &process;
    Task& task = all_.run.table.AddTask(number);
    task.process = &process;
    task.cpu = robot.cpus[0];
    robot.tasks.push_back(&task);
    robot.scheduler.Add(task.order, 0);
    all_.waker.SetState(task, TaskState::kReady);
    all_.waker.Refresh(robot);
    return task;
  }
  VirtualTime HorizonOf(Task& task) {
    VirtualTime idle_until;
    return all_.horizons.Of(task, &idle_until);
  }

  std::unique_ptr<shm::RunHeader> header_ = std::make_unique<shm::RunHeader>();
  Wiring all_{OfTwoRobots(), RunOptions{}};
  RunState& run_ = all_.run;
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
  EXPECT_FALSE(all_.gate_keeper.PutOff(&task, [](Moment) { return Reactor::Found{}; }));
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

}  // namespace
}  // namespace tcs
