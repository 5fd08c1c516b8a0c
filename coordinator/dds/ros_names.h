// ROS 2's names for topics and types, and what DDS knows them by. Pure.
//
//   /odom                  rt/odom                           a topic
//   nav_msgs/msg/Odometry  nav_msgs::msg::dds_::Odometry_    its type
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tcs::dds {

// Messages that tell the state of bodies; the first kBodyMessages those of
// free bodies, all others those of robots' own sensors.
enum class SensorMessage {
  kOdometry,
  kImu,
  kJointState,
  kTwist,
  kLaserScan,
  kPointCloud,
  kRange,
  kImage,
  kNavSatFix,
  kMagneticField,
  kFluidPressure,
  kTransforms,
  kString,
  kBool
};
inline constexpr std::size_t kBodyMessages = 4;
// Messages that move bodies; the messages after the first move joints.
enum class CommandMessage { kWrench, kFloat64MultiArray, kJointState, kTwist, kJointTrajectory };

// In the order of the enumerators.
[[nodiscard]] const std::vector<std::string>& SensorMessageNames();
[[nodiscard]] const std::vector<std::string>& CommandMessageNames();
inline constexpr std::string_view kClockMessageName = "rosgraph_msgs/msg/Clock";

// The topic on which ROS 2's middleware says which node has which endpoints (participant_info.h).
// The name is DDS's.
inline constexpr std::string_view kDiscoveryTopic = "ros_discovery_info";
inline constexpr std::string_view kDiscoveryMessageName =
    "rmw_dds_common/msg/ParticipantEntitiesInfo";

// The releases of ROS 2 whose middleware says that in the same form, named by the first release of
// each form.
enum class RosRelease { kHumble, kIron };

[[nodiscard]] const std::string& NameOf(SensorMessage message);
[[nodiscard]] const std::string& NameOf(CommandMessage message);

// "nav_msgs/Odometry" means "nav_msgs/msg/Odometry"; anything else is returned as it is.
[[nodiscard]] std::string FullMessageName(std::string_view name);

// Why `topic` is no absolute name of a ROS 2 topic, as the rest of a sentence; none: `topic` is
// one.
[[nodiscard]] std::optional<std::string> WhatIsWrongWithTopic(std::string_view topic);

// The form of a scenario's name as a part of a name of ROS 2's: "r2-d2" is "r2_d2", "7" is
// "robot_7".
[[nodiscard]] std::string RosToken(std::string_view name);

[[nodiscard]] std::string DdsTopic(std::string_view ros_topic);
[[nodiscard]] std::string DdsType(std::string_view ros_message);

// Back again. A topic or type that is not ROS 2's keeps its DDS name: "DDSPerfRDataKS".
[[nodiscard]] std::string RosTopic(std::string_view dds_topic);
[[nodiscard]] std::string RosType(std::string_view dds_type);

}  // namespace tcs::dds
