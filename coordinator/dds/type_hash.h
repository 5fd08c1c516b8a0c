// The hash by which ROS 2 knows a type since Iron (REP-2011, RIHS01): SHA-256 of its description
// (type_description_interfaces/msg/TypeDescription) as JSON. Pure.
#pragma once

#include <string>
#include <string_view>

#include "coordinator/dds/ros_names.h"

namespace tcs::dds {

// Of "sensor_msgs/msg/Imu": "RIHS01_" and 64 hexadecimal digits. Empty: the release has no hashes,
// or tcs does not know the type.
[[nodiscard]] std::string TypeHashOf(std::string_view type, RosRelease release);

// The USER_DATA of an endpoint of the type, as that release's middleware expects it:
// "typehash=RIHS01_...;", or nothing.
[[nodiscard]] std::string UserDataOf(std::string_view type, RosRelease release);
// The same, for a hash.
[[nodiscard]] std::string UserDataWith(std::string_view hash);
// The hash in some endpoint's USER_DATA, which may be any bytes; empty: there is none.
[[nodiscard]] std::string TypeHashIn(std::string_view user_data);

}  // namespace tcs::dds
