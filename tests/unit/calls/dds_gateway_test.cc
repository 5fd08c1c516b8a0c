#include "coordinator/calls/dds_gateway.h"

#include <gtest/gtest.h>

#include <memory>

namespace tcs {
namespace {

using Kind = shm::NotificationKind;

// A process on a robot of one core, with two threads that may act, and that has joined.
class DdsGatewayTest : public testing::Test {
 protected:
  DdsGatewayTest() {
    run_.header = header_.get();
    waker_.Tell({.began_by_signal = [](Task&) {},
                 .left = [](Task&, const Wait&) {},
                 .ends_in_trapped_call = [](Task&, shm::WakeReason) {},
                 .deliverer_is_held_up =
                     [this](const Process& process, EventTime when) {
                       dds_.ReleaseThoseAwaitingDeliverer(process, when);
                     }});
    robot_ = &run_.robots.emplace_back("robot", 1.0, RobotScheduler(1, true, [this](int order) {
                                         return waker_.WaitOf(run_.table.At(order));
                                       }));
    VirtualCpu& cpu = run_.cpus.emplace_back();
    cpu.robot = robot_;
    cpu.leaf = run_.root.AddLeaf(1);
    robot_->cpus.push_back(&cpu);
    process_ = &run_.table.AddProcess(1);
    process_->name = "node";
    process_->robot = robot_;
    process_->client = process_;
    deliverer_ = &AddThread(0);
    other_ = &AddThread(1);
    Notify(*other_, Kind::kDdsJoin);
  }
  Task& AddThread(int number) {
    Task& task = run_.table.AddTask(number + 1);
    task.process = process_;
    task.slot = number;
    task.slot_memory = &slots_[static_cast<std::size_t>(number)];
    robot_->tasks.push_back(&task);
    robot_->scheduler.Add(task.order, 0);
    waker_.SetState(task, TaskState::kReady);
    return task;
  }
  void Notify(Task& task, Kind kind) {
    shm::Notification note{};
    note.kind = kind;
    dds_.Handle(task, note, VirtualTime::Never());
  }

  std::unique_ptr<shm::RunHeader> header_ = std::make_unique<shm::RunHeader>();
  std::unique_ptr<shm::ThreadSlot[]> slots_ = std::make_unique<shm::ThreadSlot[]>(2);
  RunState run_{Scenario{}, RunOptions{}, false};
  Activations activations_{false};
  Waker waker_{run_, activations_};
  World world_{[](const std::string&) {}};
  PriorityInheritance inheritance_{run_, waker_};
  DdsGateway dds_{run_, waker_, world_, inheritance_};
  Robot* robot_ = nullptr;
  Process* process_ = nullptr;
  Task* deliverer_ = nullptr;
  Task* other_ = nullptr;
};

TEST_F(DdsGatewayTest, WhoJoinsGetsANumberAndAnAreaUntilItLeaves) {
  EXPECT_EQ(other_->reply[0], 1);
  EXPECT_EQ(process_->dds_number, 1u);
  EXPECT_GE(dds_.AreaOf(*process_), 0);
  dds_.Leave(*process_, {});
  EXPECT_EQ(process_->dds_number, 0u);
  EXPECT_LT(dds_.AreaOf(*process_), 0);
}

TEST_F(DdsGatewayTest, TheThreadThatWaitsForMessagesIsTheDeliverer) {
  Notify(*deliverer_, Kind::kDdsWait);
  EXPECT_EQ(process_->deliverer, deliverer_);
  ASSERT_NE(deliverer_->Awaits<awaited::Messages>(), nullptr);
  EXPECT_TRUE(deliverer_->wait->deadline.IsNever());  // nothing was sent to it
}

TEST_F(DdsGatewayTest, NobodyWaitsForADelivererThatHasNothingToHandOver) {
  Notify(*other_, Kind::kDdsSync);
  EXPECT_EQ(other_->state, TaskState::kReady);
  Notify(*deliverer_, Kind::kDdsWait);
  Notify(*other_, Kind::kDdsSync);
  EXPECT_EQ(other_->state, TaskState::kReady);
}

TEST_F(DdsGatewayTest, WhoWaitsForADelivererAtWorkGoesOnWhenItComesBackForMore) {
  Notify(*deliverer_, Kind::kDdsWait);
  waker_.Wake(*deliverer_, shm::WakeReason::kGo, {});
  Notify(*other_, Kind::kDdsSync);
  ASSERT_NE(other_->Awaits<awaited::Deliverer>(), nullptr);
  EXPECT_EQ(robot_->scheduler.BlockedOn(other_->order), deliverer_->order);
  waker_.SetState(*deliverer_, TaskState::kReady);  // it has held, and is safe
  Notify(*deliverer_, Kind::kDdsWait);
  EXPECT_EQ(other_->wait, std::nullopt);
}

TEST_F(DdsGatewayTest, WhoWaitsForADelivererGoesOnWhenThatWaitsForSomethingElse) {
  Notify(*deliverer_, Kind::kDdsWait);
  waker_.Wake(*deliverer_, shm::WakeReason::kGo, {});
  Notify(*other_, Kind::kDdsSync);
  ASSERT_NE(other_->Awaits<awaited::Deliverer>(), nullptr);
  waker_.SetState(*deliverer_, TaskState::kReady);
  waker_.Wait(*deliverer_, {awaited::Nothing{}});
  EXPECT_EQ(other_->wait, std::nullopt);
}

TEST_F(DdsGatewayTest, WhenItsProcessLeavesNobodyWaitsForTheDelivererAnyMore) {
  Notify(*deliverer_, Kind::kDdsWait);
  waker_.Wake(*deliverer_, shm::WakeReason::kGo, {});
  Notify(*other_, Kind::kDdsSync);
  dds_.Leave(*process_, {});
  EXPECT_EQ(process_->deliverer, nullptr);
  EXPECT_EQ(other_->wait, std::nullopt);
}

}  // namespace
}  // namespace tcs
