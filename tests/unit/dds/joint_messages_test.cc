// What a robot's joints do and what they are told, as ROS 2 messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "coordinator/dds/robot_topics.h"

namespace tcs::dds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kArm = {"shoulder", "elbow", "wrist"};

std::vector<std::byte> Array(const std::vector<double>& numbers) {
  Owned<Float64MultiArrayMessage> message;
  Resize(&message->data, numbers.size());
  std::copy(numbers.begin(), numbers.end(), message->data._buffer);
  return ToCdr(message);
}

struct Lists {
  std::vector<std::string> names;
  std::vector<double> position, velocity, effort;
};

std::vector<std::byte> States(const Lists& lists) {
  Owned<JointStateMessage> message;
  Resize(&message->name, lists.names.size());
  for (std::size_t i = 0; i < lists.names.size(); ++i) {
    SetText(&message->name._buffer[i], lists.names[i]);
  }
  const auto fill = [](auto* list, const std::vector<double>& numbers) {
    Resize(list, numbers.size());
    std::copy(numbers.begin(), numbers.end(), list->_buffer);
  };
  fill(&message->position, lists.position);
  fill(&message->velocity, lists.velocity);
  fill(&message->effort, lists.effort);
  return ToCdr(message);
}

using DecodedGoals = std::variant<std::vector<JointGoal>, MessageError>;

std::vector<JointGoal> GoalsOf(const DecodedGoals& decoded) {
  if (const auto* error = std::get_if<MessageError>(&decoded)) {
    ADD_FAILURE() << error->message;
    return {};
  }
  return std::get<std::vector<JointGoal>>(decoded);
}

std::string Complaint(const DecodedGoals& decoded) {
  const auto* error = std::get_if<MessageError>(&decoded);
  return error == nullptr ? "" : error->message;
}

DecodedGoals FromArray(const std::vector<double>& numbers,
                       JointQuantity quantity = JointQuantity::kEffort) {
  return DecodeJointCommand(CommandMessage::kFloat64MultiArray, kArm, quantity, Array(numbers));
}

DecodedGoals FromStates(const Lists& lists) {
  return DecodeJointCommand(CommandMessage::kJointState, kArm, JointQuantity::kPosition,
                            States(lists));
}

TEST(JointStates, HaveNamesPositionsVelocitiesAndEfforts) {
  const std::vector<std::string> names = {"elbow", "wrist"};
  const std::vector<JointState> states = {{1, 2, 3}, {4, 5, 6}};
  const auto message = ToRobotJointState(1'500'000'000, names, states);
  EXPECT_EQ(message->header.stamp.sec, 1);
  EXPECT_EQ(message->header.stamp.nanosec, 500'000'000u);
  EXPECT_STREQ(message->header.frame_id, "");
  ASSERT_EQ(message->name._length, 2u);
  EXPECT_STREQ(message->name._buffer[1], "wrist");
  EXPECT_EQ(message->position._buffer[0], 1);
  EXPECT_EQ(message->velocity._buffer[1], 5);
  EXPECT_EQ(message->effort._buffer[1], 6);
  EXPECT_EQ(EncodeJoints(1'500'000'000, names, states), ToCdr(message));
}

TEST(JointCommands, OfNumbersAreForAllJointsInTheirOrder) {
  const JointGoal shoulder{.joint = 0, .velocity = 0.5}, elbow{.joint = 1, .velocity = -2},
      wrist{.joint = 2, .velocity = 0};
  EXPECT_THAT(GoalsOf(FromArray({0.5, -2, 0}, JointQuantity::kVelocity)),
              ElementsAre(shoulder, elbow, wrist));
  EXPECT_THAT(Complaint(FromArray({1, 2})), "has 2 numbers for 3 joints");
  EXPECT_THAT(Complaint(FromArray({1, 2, std::numeric_limits<double>::infinity()})),
              "has a number that is not finite");
}

TEST(JointCommands, OfStatesAreByName) {
  const JointGoal wrist{.joint = 2, .position = 1, .effort = 3},
      shoulder{.joint = 0, .position = 2, .effort = 4};
  EXPECT_THAT(GoalsOf(FromStates({{"wrist", "shoulder"}, {1, 2}, {}, {3, 4}})),
              ElementsAre(wrist, shoulder));
  EXPECT_TRUE(GoalsOf(FromStates({})).empty());
}

TEST(JointCommands, ThatAreNoneAreSaid) {
  EXPECT_EQ(Complaint(FromStates({{"elbow", "knee"}, {1, 2}, {}, {}})),
            "names 'knee', which the channel does not drive");
  EXPECT_EQ(Complaint(FromStates({{"elbow", "elbow"}, {1, 2}, {}, {}})), "names 'elbow' twice");
  EXPECT_EQ(Complaint(FromStates({{"elbow"}, {1, 2}, {}, {}})),
            "has 1 names, but a list of 2 numbers");
  EXPECT_EQ(Complaint(FromStates({{"elbow"}, {}, {}, {std::nan("")}})),
            "has a number that is not finite");
  EXPECT_THAT(Complaint(DecodeJointCommand(CommandMessage::kJointState, kArm,
                                           JointQuantity::kPosition, Array({1, 2, 3}))),
              HasSubstr("is no sensor_msgs::msg::dds_::JointState_"));
}

TEST(JointGoal, BecomesADriveWithItsGains) {
  const JointGains gains{100, 10};
  EXPECT_EQ(ToDrive({.effort = 5}, gains), (JointDrive{.effort = 5}));
  EXPECT_EQ(ToDrive({.velocity = 2}, gains), (JointDrive{.damping = 10, .velocity = 2}));
  EXPECT_EQ(ToDrive({.position = 1}, gains),
            (JointDrive{.stiffness = 100, .position = 1, .damping = 10}));
  EXPECT_EQ(ToDrive({.position = 1, .velocity = 2, .effort = 5}, gains),
            (JointDrive{5, 100, 1, 10, 2}));
  EXPECT_EQ(ToDrive({}, gains), JointDrive{});
}

}  // namespace
}  // namespace tcs::dds
