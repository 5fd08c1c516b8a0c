#include "coordinator/calls/posted_datagrams.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <string_view>

#include "coordinator/dds/hub.h"
#include "coordinator/dds/own_endpoints.h"
#include "simbody_bridge/library/physics_library.h"

namespace tcs {
namespace {

using shm::CommandRing;

constexpr VirtualTime At(std::int64_t ms) { return RobotTime(ms * 1'000'000); }

// A thread that has a turn from 10 to 20 ms, and two bodies that are commanded by UNIX datagrams.
class PostedDatagramsTest : public testing::Test {
 protected:
  explicit PostedDatagramsTest(shm::Sync sync = shm::Sync::kConsistent)
      : run_(Scenario{}, Options(sync), false) {
    SetPhysicsLibrary(TCS_PHYSICS_LIBRARY);
    scenario_.world.emplace();
    for (const char* name : {"one", "other"}) {
      scenario_.world->bodies.emplace_back().name = name;
      CommandChannelSpec& channel = scenario_.commands.emplace_back();
      channel.name = name;
      channel.body = static_cast<int>(scenario_.world->bodies.size()) - 1;
      channel.from = UnixName{.name = name + std::to_string(getpid()), .is_abstract = true};
    }
    const auto make = [](const std::string&, const std::function<void()>& at) { at(); };
    EXPECT_EQ(world_.Open(scenario_, ends_, make), "");
    world_.NameReceivers(*receivers_);
    Task& task = run_.table.AddTask(1);
    task.process = &run_.table.AddProcess(1);
    task.process->robot = &robot_;
    task.slot = 0;
    task.slot_memory = slot_.get();
    cpu_.robot = &robot_;
    cpu_.ComeTo(At(10));
    task.cpu = &cpu_;
    run_.turn.Begin(task, At(20));
    task_ = &task;
  }
  static RunOptions Options(shm::Sync sync) {
    RunOptions options;
    options.sync = sync;
    return options;
  }

  void Post(std::string_view text, std::int64_t time_ns, std::uint32_t receiver = 0) {
    CommandRing& ring = slot_->command_ring;
    ASSERT_TRUE(shm::HasRoomFor(ring, text.size()));
    shm::PostInto(ring, {time_ns, 0, receiver, static_cast<std::uint32_t>(text.size())},
                  [&](std::uint64_t at) { shm::CopyIntoRing(ring, at, text.data(), text.size()); });
  }
  // How many of the commands were sent by then.
  std::int64_t ActedBy(std::int64_t ms) {
    while (world_.progress() < At(ms)) world_.Advance(At(ms));
    return world_.commands();
  }

  static constexpr std::string_view kPush = R"({"force": [1, 0, 0]})";
  static constexpr std::int64_t kMs = 1'000'000;
  Scenario scenario_;
  dds::Hub hub_;
  dds::OwnEndpoints ends_{hub_};
  std::string warned_;
  World world_{[this](const std::string& text) { warned_ += text; }};
  std::unique_ptr<shm::OwnReceivers> receivers_ = std::make_unique<shm::OwnReceivers>();
  std::unique_ptr<shm::ThreadSlot> slot_ = std::make_unique<shm::ThreadSlot>();
  Robot robot_{"robot", 1.0, RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; })};
  VirtualCpu cpu_;
  RunState run_;
  PostedDatagrams posted_{run_, world_};
  Task* task_ = nullptr;
};

TEST_F(PostedDatagramsTest, AreTheWorldsReceiversCommandsAtTheTimesOfTheirSends) {
  EXPECT_EQ(receivers_->count, 2u);
  EXPECT_NE(receivers_->network, 0u);
  Post(kPush, 12 * kMs);
  Post(kPush, 15 * kMs, 1);
  EXPECT_EQ(posted_.Take(*task_), nullptr);
  EXPECT_EQ(slot_->command_ring.taken, slot_->command_ring.posted);
  EXPECT_EQ(world_.kept_commands(), 2u);
  EXPECT_EQ(ActedBy(14), 1);
  EXPECT_EQ(ActedBy(16), 2);
  EXPECT_EQ(posted_.Take(*task_), nullptr);
  EXPECT_EQ(world_.kept_commands(), 0u);
}

// Whatever it says, it has sent them in its turn.
TEST_F(PostedDatagramsTest, AreFromTheThreadsTurn) {
  Post(kPush, 1 * kMs);
  Post(kPush, INT64_MIN);
  Post(kPush, 25 * kMs);
  Post(kPush, INT64_MAX);
  EXPECT_EQ(posted_.Take(*task_), nullptr);
  EXPECT_EQ(ActedBy(9), 0);
  EXPECT_EQ(ActedBy(11), 2);
  EXPECT_EQ(ActedBy(19), 2);
  EXPECT_EQ(ActedBy(21), 4);
}

TEST_F(PostedDatagramsTest, ThatAreNoCommandsAreToldOf) {
  Post("push!", 12 * kMs, 1);
  EXPECT_EQ(posted_.Take(*task_), nullptr);
  EXPECT_NE(warned_.find("the command datagram is not valid JSON"), std::string::npos) << warned_;
}

TEST_F(PostedDatagramsTest, ThatCannotBeAreSaidToBeSo) {
  Post(kPush, 12 * kMs, 2);
  EXPECT_NE(posted_.Take(*task_), nullptr);
  task_->posts_taken = slot_->command_ring.posted;
  slot_->command_ring.posted += 8;
  EXPECT_NE(posted_.Take(*task_), nullptr);
  slot_->command_ring.posted -= 16;
  EXPECT_NE(posted_.Take(*task_), nullptr);
  slot_->command_ring.posted = ~std::uint64_t{0};
  EXPECT_NE(posted_.Take(*task_), nullptr);
  EXPECT_EQ(world_.kept_commands(), 0u);
}

TEST_F(PostedDatagramsTest, GoNowhereOnceTheWorldHasStopped) {
  Post(kPush, 12 * kMs);
  run_.grace_began = At(10);
  EXPECT_EQ(posted_.Take(*task_), nullptr);
  EXPECT_EQ(slot_->command_ring.taken, slot_->command_ring.posted);
  EXPECT_EQ(world_.kept_commands(), 0u);
}

// The world stands still while the program's own clock goes on.
class PostedInCallbackTest : public PostedDatagramsTest {
 protected:
  PostedInCallbackTest() : PostedDatagramsTest(shm::Sync::kCallback) {}
};

TEST_F(PostedInCallbackTest, AreFromWhereTheWorldStands) {
  Post(kPush, 18 * kMs);
  EXPECT_EQ(posted_.Take(*task_), nullptr);
  EXPECT_EQ(ActedBy(9), 0);
  EXPECT_EQ(ActedBy(11), 1);
}

}  // namespace
}  // namespace tcs
