// The definitions of ROS 2's messages, so that a recording can be read without the packages that
// define them.
#pragma once

#include <string>
#include <string_view>

#include "coordinator/dds/ros_names.h"

namespace tcs::record {

// The definition of the type ("sensor_msgs/msg/Imu") as `release` has it, in the form that rosbag2
// and MCAP call ros2msg: its text, and then the texts of all types that it consists of, each once
// and after a line of '=' and the type's name. Empty: tcs does not know the type.
std::string DefinitionOf(std::string_view type, dds::RosRelease release);

}  // namespace tcs::record
