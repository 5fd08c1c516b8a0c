#include "coordinator/dds/ros_names.h"

#include <cstddef>

namespace tcs::dds {
namespace {

constexpr std::string_view kTopicPrefix = "rt/";
constexpr std::string_view kNamespace = "::msg::dds_::";
constexpr std::string_view kFolder = "/msg/";
// DDS allows 255 characters of which "rt" are two.
constexpr std::size_t kLongestTopic = 253;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool IsWordCharacter(char c) { return IsDigit(c) || c == '_' || IsLetter(c); }

}  // namespace

const std::vector<std::string>& SensorMessageNames() {
  static const std::vector<std::string> names = {
      "nav_msgs/msg/Odometry",         "sensor_msgs/msg/Imu",
      "sensor_msgs/msg/JointState",    "geometry_msgs/msg/Twist",
      "sensor_msgs/msg/LaserScan",     "sensor_msgs/msg/PointCloud2",
      "sensor_msgs/msg/Range",         "sensor_msgs/msg/Image",
      "sensor_msgs/msg/NavSatFix",     "sensor_msgs/msg/MagneticField",
      "sensor_msgs/msg/FluidPressure", "tf2_msgs/msg/TFMessage",
      "std_msgs/msg/String",           "std_msgs/msg/Bool"};
  return names;
}

const std::vector<std::string>& CommandMessageNames() {
  static const std::vector<std::string> names = {
      "geometry_msgs/msg/Wrench", "std_msgs/msg/Float64MultiArray", "sensor_msgs/msg/JointState",
      "geometry_msgs/msg/Twist", "trajectory_msgs/msg/JointTrajectory"};
  return names;
}

const std::string& NameOf(SensorMessage message) {
  return SensorMessageNames()[static_cast<std::size_t>(message)];
}

const std::string& NameOf(CommandMessage message) {
  return CommandMessageNames()[static_cast<std::size_t>(message)];
}

std::string FullMessageName(std::string_view name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos || name.find('/', slash + 1) != std::string_view::npos) {
    return std::string(name);
  }
  return std::string(name.substr(0, slash)) + std::string(kFolder) +
         std::string(name.substr(slash + 1));
}

std::optional<std::string> WhatIsWrongWithTopic(std::string_view topic) {
  if (topic.empty() || topic[0] != '/') return "does not begin with '/'";
  if (topic.size() > kLongestTopic) return "is longer than 253 characters";
  if (topic.back() == '/') return "ends with '/'";
  char before = 0;
  for (const char c : topic) {
    if (c != '/' && !IsWordCharacter(c)) {
      return "has a character other than letters, digits, '_' and '/'";
    }
    if (before == '/' && c == '/') return "has nothing between two '/'";
    if (before == '/' && IsDigit(c)) return "has a digit right after '/'";
    if (before == '_' && c == '_') return "has two '_' in a row";
    before = c;
  }
  return std::nullopt;
}

std::string RosToken(std::string_view name) {
  std::string token;
  // A token that began with '_' would be hidden.
  if (name.empty() || !IsLetter(name[0])) token = "robot_";
  for (const char c : name) {
    const char allowed = IsWordCharacter(c) ? c : '_';
    if (allowed != '_' || !token.ends_with('_')) token += allowed;
  }
  return token;
}

std::string DdsTopic(std::string_view ros_topic) { return "rt" + std::string(ros_topic); }

std::string DdsType(std::string_view ros_message) {
  const std::size_t folder = ros_message.find(kFolder);
  if (folder == std::string_view::npos) return std::string(ros_message);
  return std::string(ros_message.substr(0, folder)) + std::string(kNamespace) +
         std::string(ros_message.substr(folder + kFolder.size())) + "_";
}

std::string RosTopic(std::string_view dds_topic) {
  if (!dds_topic.starts_with(kTopicPrefix)) return std::string(dds_topic);
  return std::string(dds_topic.substr(kTopicPrefix.size() - 1));
}

std::string RosType(std::string_view dds_type) {
  const std::size_t middle = dds_type.find(kNamespace);
  if (middle == std::string_view::npos || !dds_type.ends_with('_')) return std::string(dds_type);
  const std::string_view name = dds_type.substr(middle + kNamespace.size());
  return std::string(dds_type.substr(0, middle)) + std::string(kFolder) +
         std::string(name.substr(0, name.size() - 1));
}

}  // namespace tcs::dds
