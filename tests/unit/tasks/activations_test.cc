#include "coordinator/tasks/activations.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/unit/times.h"

namespace tcs {
namespace {

constexpr ProgramTime OwnAt(VirtualDuration since_start) { return ProgramTime() + since_start; }

// A thread that has registered, and never runs.
class ActivationsTest : public testing::Test {
 protected:
  ActivationsTest() {
    process_.name = "planner";
    process_.robot = &robot_;
    task_.process = &process_;
    task_.slot = 0;
    task_.slot_memory = slot_.get();
    EXPECT_EQ(activations_.Open(path_, false), "");
  }
  ~ActivationsTest() override { unlink(path_.c_str()); }

  template <class What>
  void WaitsFor(VirtualTime deadline = VirtualTime::Never()) {
    Wait& wait = task_.wait.emplace();
    wait.what.emplace<What>();
    wait.deadline = deadline;
  }
  // It runs from then on, and comes to a wait at `end`.
  void Runs(VirtualDuration start, VirtualDuration end, VirtualDuration charged) {
    task_.wait.reset();
    task_.activation.start_ns = start.ns();
    task_.reached = At(end);
    task_.charged += charged;
    activations_.Idles(task_);
  }
  std::vector<std::string> Lines() {
    EXPECT_EQ(activations_.Close(), "");
    std::ifstream file(path_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    if (!lines.empty()) lines.erase(lines.begin());  // the header
    return lines;
  }

  const std::string path_ = testing::TempDir() + "activations_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
  std::unique_ptr<shm::ThreadSlot> slot_ = std::make_unique<shm::ThreadSlot>();
  Robot robot_{"robot", 1.0, RobotScheduler(1, false, [](RobotScheduler::Thread) {
                 return RobotScheduler::Wait{};
               })};
  Process process_;
  Task task_;
  Activations activations_{false};
};

TEST_F(ActivationsTest, WhatWasDueBeforeItWasLookedAtWasDueThen) {
  WaitsFor<awaited::Time>(At(10 * kMs));
  activations_.Released(task_, shm::WakeReason::kDeadline, At(12 * kMs), VirtualDuration());
  Runs(12 * kMs, 15 * kMs, 3 * kMs);
  EXPECT_EQ(Lines(), std::vector<std::string>{"planner,0,time,10000000,12000000,15000000,3000000"});
}

TEST_F(ActivationsTest, TheCauseIsWhatTheWaitWasFor) {
  WaitsFor<awaited::Descriptors>();
  activations_.Released(task_, shm::WakeReason::kGo, At(1 * kMs), VirtualDuration());
  Runs(1 * kMs, 2 * kMs, {});
  WaitsFor<awaited::Futex>();
  activations_.Released(task_, shm::WakeReason::kGo, At(3 * kMs), VirtualDuration());
  Runs(3 * kMs, 4 * kMs, {});
  WaitsFor<awaited::Child>();
  activations_.Released(task_, shm::WakeReason::kGo, At(5 * kMs), VirtualDuration());
  Runs(5 * kMs, 6 * kMs, {});
  EXPECT_EQ(Lines(), (std::vector<std::string>{"planner,0,input,1000000,1000000,2000000,0",
                                               "planner,0,thread,3000000,3000000,4000000,0",
                                               "planner,0,child,5000000,5000000,6000000,0"}));
}

// The release is the event's time, however long the kernel takes to wake the thread.
TEST_F(ActivationsTest, WakingAThreadIsPartOfItsActivation) {
  WaitsFor<awaited::Descriptors>();
  activations_.Released(task_, shm::WakeReason::kGo, At(1 * kMs), kMs / 2);
  EXPECT_EQ(task_.activation.release_ns, (1 * kMs).ns());
  EXPECT_EQ(task_.activation.wakeup_ns, (kMs / 2).ns());
}

TEST_F(ActivationsTest, WhoNeverRegisteredHasNone) {
  task_.slot = -1;
  Runs(1 * kMs, 2 * kMs, {});
  EXPECT_TRUE(Lines().empty());
}

TEST_F(ActivationsTest, NoneIsChargedLessThanNothing) {
  WaitsFor<awaited::Descriptors>();
  activations_.Released(task_, shm::WakeReason::kGo, VirtualTime(), VirtualDuration());
  Runs({}, 1 * kMs, 5 * kMs);
  WaitsFor<awaited::Descriptors>();
  activations_.Released(task_, shm::WakeReason::kGo, At(2 * kMs), VirtualDuration());
  Runs(2 * kMs, 3 * kMs, -kMs);
  WaitsFor<awaited::Descriptors>();
  activations_.Released(task_, shm::WakeReason::kGo, At(4 * kMs), VirtualDuration());
  Runs(4 * kMs, 5 * kMs, 3 * kMs);
  EXPECT_EQ(Lines(), (std::vector<std::string>{"planner,0,input,0,0,1000000,5000000",
                                               "planner,0,input,2000000,2000000,3000000,0",
                                               "planner,0,input,4000000,4000000,5000000,2000000"}));
}

TEST_F(ActivationsTest, WhatWasReceivedWithoutWaitingBeginsTheNextOne) {
  task_.activation.release_ns = task_.activation.start_ns = kMs.ns();
  task_.charged = 9 * kMs;
  shm::Receipts& receipts = slot_->receipts;
  receipts.entries[0] = {
      .time_ns = (4 * kMs).ns(), .cpu_ns = (3 * kMs).ns(), .of = shm::Receipts::Of::kMessage};
  receipts.entries[1] = {
      .time_ns = (7 * kMs).ns(), .cpu_ns = (6 * kMs).ns(), .of = shm::Receipts::Of::kTimer};
  receipts.count = 2;
  activations_.TakeReceipts(task_, OwnAt(10 * kMs));
  EXPECT_EQ(receipts.count, 0u);
  EXPECT_EQ(task_.activations, 2);
  task_.reached = At(10 * kMs);
  activations_.Idles(task_);
  EXPECT_EQ(Lines(), (std::vector<std::string>{"planner,0,start,1000000,1000000,4000000,3000000",
                                               "planner,0,input,4000000,4000000,7000000,3000000",
                                               "planner,0,time,7000000,7000000,10000000,3000000"}));
}

// One to the next time of a loop, and one to a time that is past.
TEST_F(ActivationsTest, ASleepThatNeedsNoAskingIsAWait) {
  task_.activation.release_ns = task_.activation.start_ns = kMs.ns();
  task_.charged = 9 * kMs;
  shm::Receipts& receipts = slot_->receipts;
  receipts.entries[0] = {.time_ns = (4 * kMs).ns(),
                         .cpu_ns = (3 * kMs).ns(),
                         .release_ns = (6 * kMs).ns(),
                         .of = shm::Receipts::Of::kSleep};
  receipts.entries[1] = {.time_ns = (9 * kMs).ns(),
                         .cpu_ns = (6 * kMs).ns(),
                         .release_ns = (8 * kMs).ns(),
                         .of = shm::Receipts::Of::kSleep};
  receipts.count = 2;
  activations_.TakeReceipts(task_, OwnAt(12 * kMs));
  task_.reached = At(12 * kMs);
  activations_.Idles(task_);
  EXPECT_EQ(Lines(), (std::vector<std::string>{"planner,0,start,1000000,1000000,4000000,3000000",
                                               "planner,0,time,6000000,6000000,9000000,3000000",
                                               "planner,0,time,8000000,9000000,12000000,3000000"}));
}

TEST_F(ActivationsTest, ReceiptsAreNotBelievedBeyondWhatTheThreadCanHaveHad) {
  task_.activation.release_ns = task_.activation.start_ns = kMs.ns();
  task_.charged = 2 * kMs;
  slot_->receipts.entries[0] = {.time_ns = (900 * kMs).ns(), .cpu_ns = (800 * kMs).ns()};
  slot_->receipts.count = ~0u;
  activations_.TakeReceipts(task_, OwnAt(3 * kMs));
  EXPECT_EQ(Lines().front(), "planner,0,start,1000000,1000000,3000000,2000000");
}

TEST_F(ActivationsTest, AClockThatIsAheadOfTheWorldsDoesNotGoBack) {
  Activations own(true);
  process_.clock.ComeTo(OwnAt(30 * kMs));
  WaitsFor<awaited::Descriptors>();
  own.Released(task_, shm::WakeReason::kGo, At(10 * kMs), VirtualDuration());
  EXPECT_EQ(task_.activation.release_ns, (30 * kMs).ns());
}

}  // namespace
}  // namespace tcs
