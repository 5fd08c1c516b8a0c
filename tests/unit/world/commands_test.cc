#include "coordinator/world/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

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
  commands_.Take(0, VirtualTime{}, {.force_n = {1, 2, 3}});
  commands_.Take(1, VirtualTime{}, {.force_n = {1, -2, 3}, .torque_nm = {7, 0, 0}});
  EXPECT_EQ(acted_[0].wrench, (Wrench{.force_n = {1, 2, 3}}));
  EXPECT_EQ(acted_[1].wrench, (Wrench{.force_n = {1, -1, 1},
                                      .torque_nm = {7, 0, 0},
                                      .in_body_frame = true,
                                      .lag = VirtualDuration::Milliseconds(50)}));
}

TEST_F(CommandsTest, WhatIsNoneIsNamedOnceAndCounted) {
  for (int i = 0; i < 3; ++i) commands_.Refuse(1, "it is no JSON");
  commands_.Take(1, VirtualTime{}, Wrench{});
  EXPECT_THAT(warnings_, ElementsAre("channel stern: it is no JSON"));
  EXPECT_EQ(Complaint(1), "channel stern: 3 of the 4 messages that came in were no commands");
}

TEST_F(CommandsTest, ASilentChannelIsNamedAtTheEnd) {
  EXPECT_EQ(Complaint(0),
            "channel bow: nothing came in there, so no command moved ship; let a client send "
            "some");
  commands_.Take(0, VirtualTime{}, Wrench{});
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
  servo.joints = JointDriveSpec{{"arm", {8, 5}, {"elbow", "wrist"}},
                                JointQuantity::kPosition,
                                {{100, 10}, {50, 5}},
                                {{}, {}}};
  commands.Open({servo, {.name = "bow", .body = 3}});
  ASSERT_TRUE(commands.GoalsOf(0).has_value());
  EXPECT_EQ(commands.GoalsOf(0)->names[1], "wrist");
  EXPECT_FALSE(commands.GoalsOf(1).has_value());
  const std::vector<JointGoal> goals = {{.joint = 1, .position = 0.5}, {.joint = 0, .effort = 3}};
  commands.Take(0, VirtualTime{}, goals);
  ASSERT_EQ(driven.size(), 2u);
  EXPECT_EQ(driven[0].latency, VirtualDuration::Milliseconds(2));
  EXPECT_EQ(driven[0].joint, 5);
  EXPECT_EQ(driven[0].drive, (JointDrive{.stiffness = 50, .position = 0.5, .damping = 5}));
  EXPECT_EQ(driven[1].joint, 8);
  EXPECT_EQ(driven[1].drive, (JointDrive{.effort = 3}));
  EXPECT_EQ(commands.taken(), 1);
  EXPECT_THAT(commands.ComplaintsAboutActuators(), IsEmpty());
}

// A channel of two joints, one of two rotors by their share of the most, and one that pushes a
// link.
class ActuatorsTest : public testing::Test {
 protected:
  ActuatorsTest() {
    CommandChannelSpec arm{.name = "servos"};
    arm.joints = JointDriveSpec{{"arm", {8, 5}, {"elbow", "wrist"}},
                                JointQuantity::kPosition,
                                {{100, 10}, {50, 5}},
                                {{.lower = -1, .upper = 2, .effort = 30, .velocity = 4}, {}}};
    CommandChannelSpec motors{.name = "motors", .latency = VirtualDuration::Milliseconds(2)};
    motors.rotors = RotorDriveSpec{"drone", {3, 4}, {"left", "right"}, {900, 1000}, true};
    CommandChannelSpec gusts{.name = "gusts", .most_force_n = {1, 1, 1}, .in_body_frame = true};
    gusts.link = LinkTarget{"drone/base", 7};
    CommandChannelSpec again = motors;
    again.name = "again";
    again.rotors->is_normalised = false;
    commands_.Open({arm, motors, gusts, again});
  }

  std::vector<std::string> warnings_;
  std::vector<std::pair<int, double>> spun_;
  std::vector<JointDrive> driven_;
  std::vector<Wrench> pushed_;
  Commands commands_{
      [this](const std::string& text) { warnings_.push_back(text); },
      {},
      [this](VirtualTime, VirtualDuration, int, const JointDrive& d) { driven_.push_back(d); },
      [this](VirtualTime, VirtualDuration, int rotor, double speed) {
        spun_.emplace_back(rotor, speed);
      },
      [this](VirtualTime, VirtualDuration, int link, WrenchFrame frame, const Wrench& wrench) {
        EXPECT_EQ(link, 7);
        EXPECT_EQ(frame, WrenchFrame::kLink);
        pushed_.push_back(wrench);
      }};
};

std::vector<JointGoal> Speeds(double left, double right) {
  return {{.joint = 0, .velocity = left}, {.joint = 1, .velocity = right}};
}

TEST_F(ActuatorsTest, RotorsAreSpunByTheirShareOrSpeed) {
  commands_.Take(1, AtMs(1), Speeds(0.5, 1));
  commands_.Take(3, AtMs(2), Speeds(123, 0));
  EXPECT_THAT(spun_, ElementsAre(Pair(3, 450), Pair(4, 1000), Pair(3, 123), Pair(4, 0)));
  EXPECT_THAT(commands_.ComplaintsAboutActuators(), IsEmpty());
}

TEST_F(ActuatorsTest, RotorsHaveSpeedsAlone) {
  const std::vector<JointGoal> goals = {{.joint = 1, .position = 2}};
  commands_.Take(1, AtMs(1), goals);
  EXPECT_THAT(spun_, IsEmpty());
  EXPECT_THAT(
      warnings_,
      ElementsAre("channel motors: a command sets something other than a speed for rotor 'right'"));
}

TEST(CommandsToFollowers, AreTakenButForTheFollowers) {
  std::vector<std::string> warnings;
  std::vector<std::pair<int, double>> driven;
  Commands commands{[&](const std::string& text) { warnings.push_back(text); },
                    {},
                    [&](VirtualTime, VirtualDuration, int joint, const JointDrive& drive) {
                      driven.emplace_back(joint, drive.position);
                    }};
  CommandChannelSpec gripper{.name = "gripper"};
  gripper.joints = JointDriveSpec{{"hand", {4}, {"left"}, {"right"}},
                                  JointQuantity::kPosition,
                                  {{100, 10}},
                                  {{.lower = 0, .upper = 0.04}}};
  commands.Open({gripper});
  const auto names = commands.GoalsOf(0);
  EXPECT_THAT(names->names, ElementsAre("left", "right"));
  EXPECT_THAT(names->Driven(), ElementsAre("left"));
  for (const double position : {0.01, 0.05}) {
    commands.Take(0, AtMs(1),
                  std::vector<JointGoal>{{.joint = 1, .position = position},
                                         {.joint = 0, .position = position}});
  }
  EXPECT_EQ(commands.taken(), 2);
  EXPECT_THAT(driven, ElementsAre(Pair(4, 0.01), Pair(4, 0.04)));
  EXPECT_THAT(warnings, ElementsAre("channel gripper: commands name joint 'right', which follows "
                                    "another one and is driven by that alone: what they say of it "
                                    "is left out"));
}

TEST_F(ActuatorsTest, LinksArePushedWithinTheLimits) {
  commands_.Take(2, AtMs(1), {.force_n = {3, 0, -3}, .torque_nm = {0, 0, 5}});
  EXPECT_THAT(pushed_, ElementsAre(Wrench{.force_n = {1, 0, -1}, .torque_nm = {0, 0, 5}}));
}

TEST_F(ActuatorsTest, WhatIsBeyondTheLimitsIsCutAndSaid) {
  commands_.Take(1, AtMs(10), Speeds(1.5, 0.2));
  commands_.Take(1, AtMs(20), Speeds(-0.1, 0.2));
  EXPECT_THAT(spun_, ElementsAre(Pair(3, 900), Pair(4, 200), Pair(3, 0), Pair(4, 200)));
  const std::vector<JointGoal> goals = {{.joint = 0, .position = 3, .velocity = -5, .effort = 31},
                                        {.joint = 1, .position = 300}};
  commands_.Take(0, AtMs(30), goals);
  EXPECT_EQ(
      driven_[0],
      (JointDrive{.effort = 30, .stiffness = 100, .position = 2, .damping = 10, .velocity = -4}));
  EXPECT_THAT(commands_.ComplaintsAboutActuators(),
              ElementsAre("joint 'elbow' of arm was commanded once beyond its limit, first at 0.03 "
                          "s: the position 3, of which it got 2",
                          "rotor 'left' of drone was commanded twice beyond its limit, first at "
                          "0.012 s: the speed 1.5, of which it got 1"));
}

// A thread's clock stands still where it has shown stolen time, or has come to its horizon.
TEST_F(ActuatorsTest, CommandsBetweenWhichTheirSenderHasComputedAreForDifferentInstants) {
  constexpr std::uint64_t kOne = 7, kOther = 8;
  const std::vector<JointGoal> left = {{.joint = 0, .velocity = 0.1}};
  commands_.Take(1, AtMs(1), Speeds(0.1, 0.2));
  commands_.Take(1, {AtMs(10), {kOne, 5000}}, left);
  commands_.Take(1, {AtMs(10), {kOne, 5100}}, left);
  commands_.Take(1, {AtMs(10), {kOne, 5050}}, left);
  EXPECT_THAT(commands_.ComplaintsAboutActuators(), IsEmpty());
  commands_.Take(1, {AtMs(20), {kOne, 6000}}, left);
  commands_.Take(1, {AtMs(20), {kOther, 5050}}, left);
  EXPECT_THAT(commands_.ComplaintsAboutActuators(),
              ElementsAre(HasSubstr("rotor 'left' of drone was commanded once at an instant for "
                                    "which it already had a command, first at 0.022 s")));
  commands_.Take(1, {AtMs(30), {kOther, 7000}}, left);
  commands_.Take(1, {AtMs(30), {kOther, 7000}}, left);
  EXPECT_THAT(commands_.ComplaintsAboutActuators(), ElementsAre(HasSubstr("twice at an instant")));
}

TEST_F(ActuatorsTest, WhatIsCommandedAgainAtOneInstantIsSaid) {
  commands_.Take(1, AtMs(10), Speeds(0.1, 0.2));
  commands_.Take(3, AtMs(10), Speeds(100, 200));
  commands_.Take(3, AtMs(10), std::vector<JointGoal>{{.joint = 1, .velocity = 300}});
  commands_.Take(3, AtMs(11), Speeds(100, 200));
  EXPECT_THAT(
      commands_.ComplaintsAboutActuators(),
      ElementsAre(
          "rotor 'left' of drone was commanded once at an instant for which it already had a "
          "command, first at 0.012 s (channel motors and again); the last command acted",
          "rotor 'right' of drone was commanded twice at an instant for which it already had a "
          "command, first at 0.012 s (channel motors and again); the last command acted"));
}

// Of a channel on which nothing comes in another sentence tells.
TEST_F(ActuatorsTest, WhatIsNeverCommandedIsSaid) {
  EXPECT_THAT(commands_.ComplaintsAboutActuators(), IsEmpty());
  commands_.Take(1, AtMs(10), std::vector<JointGoal>{{.joint = 1, .velocity = 0.3}});
  EXPECT_THAT(commands_.ComplaintsAboutActuators(),
              ElementsAre("rotor 'left' of drone was never commanded, though others of channel "
                          "motors and again were"));
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
  std::vector<Driven> driven_;
  Commands commands_{[](const std::string&) {},
                     {},
                     [this](VirtualTime sent, VirtualDuration, int joint, const JointDrive& drive) {
                       driven_.push_back({sent.ns() / 1'000'000, joint, drive});
                     }};
};

TEST_F(WheelCommandsTest, EachWheelTurnsAsTheRobotIsToGo) {
  commands_.Take(0, AtMs(7), PlanarSpeed{.forward_mps = 1, .turn_radps = 2});
  ASSERT_EQ(driven_.size(), 3u);
  EXPECT_EQ(driven_[0].joint, 4);
  EXPECT_EQ(driven_[0].drive, (JointDrive{.damping = 2, .velocity = 5}));
  EXPECT_EQ(driven_[1].drive, (JointDrive{.damping = 2, .velocity = 15}));
  EXPECT_EQ(driven_[2].drive, (JointDrive{.damping = 3, .velocity = 15}));
}

TEST_F(WheelCommandsTest, NoWheelIsToTurnFasterThanItCanAndTheArcStays) {
  commands_.Take(0, AtMs(7), PlanarSpeed{.forward_mps = 2, .turn_radps = 8});
  EXPECT_EQ(driven_[0].drive.velocity, 0);
  EXPECT_EQ(driven_[1].drive.velocity, 20);
}

TEST_F(WheelCommandsTest, WithoutACommandTheRobotStops) {
  EXPECT_EQ(commands_.NextStop(), VirtualTime::Never());
  commands_.Take(0, AtMs(100), PlanarSpeed{.forward_mps = 1});
  commands_.Take(0, AtMs(300), PlanarSpeed{.forward_mps = 1});
  EXPECT_EQ(commands_.NextStop(), AtMs(800));
  commands_.ActUntil(AtMs(799));
  EXPECT_EQ(driven_.size(), 6u);
  commands_.ActUntil(AtMs(900));
  ASSERT_EQ(driven_.size(), 9u);
  EXPECT_EQ(driven_[6].sent_ms, 800);
  EXPECT_EQ(driven_[6].drive.velocity, 0);
  EXPECT_EQ(commands_.NextStop(), VirtualTime::Never());
  commands_.ActUntil(AtMs(2000));
  EXPECT_EQ(driven_.size(), 9u);
}

// The dynamics may learn of a command only when its time to stop has passed as well.
TEST_F(WheelCommandsTest, TheRobotHasStoppedInTimeWhoeverSendsAfterwards) {
  commands_.Take(0, AtMs(100), PlanarSpeed{.forward_mps = 1});
  commands_.Take(0, AtMs(700), PlanarSpeed{.forward_mps = 1});
  ASSERT_EQ(driven_.size(), 9u);
  EXPECT_EQ(driven_[3].sent_ms, 600);
  EXPECT_EQ(driven_[3].drive.velocity, 0);
  EXPECT_EQ(driven_[6].sent_ms, 700);
}

}  // namespace
}  // namespace tcs
