#include "coordinator/world/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tcs {
namespace {

using testing::ElementsAre;

class CommandsTest : public testing::Test {
 protected:
  CommandsTest() {
    commands_.Open({{.name = "bow", .body = 3, .latency = VirtualDuration::Milliseconds(2)},
                    {.name = "stern",
                     .body = 4,
                     .most_force_n = {1, 1, 1},
                     .in_body_frame = true,
                     .lag = VirtualDuration::Milliseconds(50)}});
  }
  std::string Complaint(std::size_t channel) {
    return commands_.ComplaintAbout(channel, {.where = "there", .mend = "send some"}, "ship");
  }

  struct Acted {
    VirtualTime sent;
    VirtualDuration latency;
    int body;
    Wrench wrench;
  };
  std::vector<std::string> warnings_;
  std::vector<Acted> acted_;
  Commands commands_{
      [this](const std::string& text) { warnings_.push_back(text); },
      [this](VirtualTime sent, VirtualDuration latency, int body, const Wrench& wrench) {
        acted_.push_back({sent, latency, body, wrench});
      }};
};

TEST_F(CommandsTest, ActOnTheirChannelsBody) {
  commands_.Take(0, VirtualTime::FromNanoseconds(7), {.force_n = {1, 2, 3}});
  ASSERT_EQ(acted_.size(), 1u);
  EXPECT_EQ(acted_[0].sent.ns(), 7);
  EXPECT_EQ(acted_[0].latency, VirtualDuration::Milliseconds(2));
  EXPECT_EQ(acted_[0].body, 3);
  EXPECT_THAT(acted_[0].wrench.force_n, ElementsAre(1, 2, 3));
  EXPECT_EQ(commands_.taken(), 1);
}

TEST_F(CommandsTest, ActAsTheirChannelSays) {
  commands_.Take(0, {}, {.force_n = {1, 2, 3}});
  commands_.Take(1, {}, {.force_n = {1, -2, 3}, .torque_nm = {7, 0, 0}});
  EXPECT_EQ(acted_[0].wrench, (Wrench{.force_n = {1, 2, 3}}));
  EXPECT_EQ(acted_[1].wrench, (Wrench{.force_n = {1, -1, 1},
                                      .torque_nm = {7, 0, 0},
                                      .in_body_frame = true,
                                      .lag = VirtualDuration::Milliseconds(50)}));
}

TEST_F(CommandsTest, WhatIsNoneIsNamedOnceAndCounted) {
  for (int i = 0; i < 3; ++i) commands_.Refuse(1, "it is no JSON");
  commands_.Take(1, {}, Wrench{});
  EXPECT_THAT(warnings_, ElementsAre("channel stern: it is no JSON"));
  EXPECT_EQ(Complaint(1), "channel stern: 3 of the 4 messages that came in were no commands");
}

TEST_F(CommandsTest, ASilentChannelIsNamedAtTheEnd) {
  EXPECT_EQ(Complaint(0),
            "channel bow: nothing came in there, so that no command moved ship; let a client send "
            "some");
  commands_.Take(0, {}, Wrench{});
  EXPECT_EQ(Complaint(0), "");
}

TEST(JointCommandsTest, DriveTheJointsOfTheirChannelWithItsGains) {
  struct Driven {
    VirtualDuration latency;
    int joint;
    JointDrive drive;
  };
  std::vector<Driven> driven;
  Commands commands({}, {},
                    [&](VirtualTime, VirtualDuration latency, int joint, const JointDrive& drive) {
                      driven.push_back({latency, joint, drive});
                    });
  CommandChannelSpec servo{.name = "servo", .latency = VirtualDuration::Milliseconds(2)};
  servo.joints = JointDriveSpec{
      {"arm", {8, 5}, {"elbow", "wrist"}}, JointQuantity::kPosition, {{100, 10}, {50, 5}}};
  commands.Open({servo, {.name = "bow", .body = 3}});
  ASSERT_NE(commands.JointsOf(0), nullptr);
  EXPECT_EQ(commands.JointsOf(0)->group.names[1], "wrist");
  EXPECT_EQ(commands.JointsOf(1), nullptr);
  const std::vector<JointGoal> goals = {{.joint = 1, .position = 0.5}, {.joint = 0, .effort = 3}};
  commands.Take(0, {}, goals);
  ASSERT_EQ(driven.size(), 2u);
  EXPECT_EQ(driven[0].latency, VirtualDuration::Milliseconds(2));
  EXPECT_EQ(driven[0].joint, 5);
  EXPECT_EQ(driven[0].drive, (JointDrive{.stiffness = 50, .position = 0.5, .damping = 5}));
  EXPECT_EQ(driven[1].joint, 8);
  EXPECT_EQ(driven[1].drive, (JointDrive{.effort = 3}));
  EXPECT_EQ(commands.taken(), 1);
}

// Two wheels of 0.1 m on each side of a robot that is 0.5 m wide.
class WheelCommandsTest : public testing::Test {
 protected:
  WheelCommandsTest() {
    JointDriveSpec joints;
    joints.group = {"rover", {4, 5, 6}, {"left", "right", "rear right"}};
    joints.gains = {{0, 2}, {0, 2}, {0, 3}};
    joints.wheels = {.base = {.separation_m = 0.5, .radius_m = 0.1},
                     .left = 1,
                     .most_radps = 20,
                     .timeout = VirtualDuration::Milliseconds(500)};
    commands_.Open({{.name = "drive", .joints = joints}});
  }

  struct Driven {
    std::int64_t sent_ms;
    int joint;
    JointDrive drive;
  };
  static constexpr VirtualTime Ms(std::int64_t ms) {
    return VirtualTime::FromNanoseconds(ms * 1'000'000);
  }
  std::vector<Driven> driven_;
  Commands commands_{[](const std::string&) {},
                     {},
                     [this](VirtualTime sent, VirtualDuration, int joint, const JointDrive& drive) {
                       driven_.push_back({sent.ns() / 1'000'000, joint, drive});
                     }};
};

TEST_F(WheelCommandsTest, EachWheelTurnsAsTheRobotIsToGo) {
  commands_.Take(0, Ms(7), PlanarSpeed{.forward_mps = 1, .turn_radps = 2});
  ASSERT_EQ(driven_.size(), 3u);
  EXPECT_EQ(driven_[0].joint, 4);
  EXPECT_EQ(driven_[0].drive, (JointDrive{.damping = 2, .velocity = 5}));
  EXPECT_EQ(driven_[1].drive, (JointDrive{.damping = 2, .velocity = 15}));
  EXPECT_EQ(driven_[2].drive, (JointDrive{.damping = 3, .velocity = 15}));
}

TEST_F(WheelCommandsTest, NoWheelIsToTurnFasterThanItCanAndTheArcStays) {
  commands_.Take(0, Ms(7), PlanarSpeed{.forward_mps = 2, .turn_radps = 8});
  EXPECT_EQ(driven_[0].drive.velocity, 0);
  EXPECT_EQ(driven_[1].drive.velocity, 20);
}

TEST_F(WheelCommandsTest, WithoutACommandTheRobotStops) {
  EXPECT_EQ(commands_.NextStop(), VirtualTime::Never());
  commands_.Take(0, Ms(100), PlanarSpeed{.forward_mps = 1});
  commands_.Take(0, Ms(300), PlanarSpeed{.forward_mps = 1});
  EXPECT_EQ(commands_.NextStop(), Ms(800));
  commands_.ActUntil(Ms(799));
  EXPECT_EQ(driven_.size(), 6u);
  commands_.ActUntil(Ms(900));
  ASSERT_EQ(driven_.size(), 9u);
  EXPECT_EQ(driven_[6].sent_ms, 800);
  EXPECT_EQ(driven_[6].drive.velocity, 0);
  EXPECT_EQ(commands_.NextStop(), VirtualTime::Never());
  commands_.ActUntil(Ms(2000));
  EXPECT_EQ(driven_.size(), 9u);
}

// The dynamics may learn of a command only when its time to stop has passed as well.
TEST_F(WheelCommandsTest, TheRobotHasStoppedInTimeWhoeverSendsAfterwards) {
  commands_.Take(0, Ms(100), PlanarSpeed{.forward_mps = 1});
  commands_.Take(0, Ms(700), PlanarSpeed{.forward_mps = 1});
  ASSERT_EQ(driven_.size(), 9u);
  EXPECT_EQ(driven_[3].sent_ms, 600);
  EXPECT_EQ(driven_[3].drive.velocity, 0);
  EXPECT_EQ(driven_[6].sent_ms, 700);
}

}  // namespace
}  // namespace tcs
