// What ROS 2's messages consist of, in ROS 2's own words, so that a recording can be read without
// the packages that define them. Comments are left out.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "coordinator/dds/ros_names.h"

namespace tcs::record {

struct MessageFields {
  std::string_view type;  // "geometry_msgs/Vector3"
  std::string_view text;  // as in its .msg file: a line for each constant and each field
};

// All types that tcs speaks, and those that they consist of, as of Iron.
std::span<const MessageFields> KnownMessages();

// Of the type "sensor_msgs/msg/Imu" as that release has it, in the form that rosbag2 and MCAP call
// ros2msg: its text, and then those of all types that it consists of, each once and after a line of
// '=' and its name. Empty: tcs does not know the type.
std::string DefinitionOf(std::string_view type, dds::RosRelease release);

}  // namespace tcs::record
