// What sensors of robots measure, as ROS 2 messages.
//
// Stamps and units as in ros_messages.h. Covariances are zero.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "coordinator/dds/ros_types.h"
#include "simbody_bridge/measurements.h"

namespace tcs::dds {

[[nodiscard]] Owned<ImuMessage> ToMessage(std::int64_t stamp_ns, const ImuMeasurement& imu);
[[nodiscard]] Owned<OdometryMessage> ToMessage(std::int64_t stamp_ns,
                                               const OdometryMeasurement& odometry);
[[nodiscard]] Owned<LaserScanMessage> ToMessage(std::int64_t stamp_ns, const ScanMeasurement& scan);

// As the bytes of its message; there is a measurement.
[[nodiscard]] std::vector<std::byte> EncodeMeasurement(std::int64_t stamp_ns,
                                                       const Measurement& measurement);

}  // namespace tcs::dds
