// The measurements of robots' sensors, as ROS 2 messages.
//
// Stamps and units as in ros_messages.h. Covariances are diagonal; where nothing is wrong with a
// value they are zero, which ROS 2 takes for unknown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "coordinator/dds/ros_names.h"
#include "coordinator/dds/ros_types.h"
#include "simbody_bridge/measurements.h"

namespace tcs::dds {

[[nodiscard]] Owned<ImuMessage> ToMessage(std::int64_t stamp_ns, const ImuMeasurement& imu);
[[nodiscard]] Owned<OdometryMessage> ToMessage(std::int64_t stamp_ns,
                                               const OdometryMeasurement& odometry);
[[nodiscard]] Owned<LaserScanMessage> ToMessage(std::int64_t stamp_ns, const ScanMeasurement& scan);
[[nodiscard]] Owned<TransformsMessage> ToMessage(std::int64_t stamp_ns,
                                                 const TransformsMeasurement& transforms);
[[nodiscard]] Owned<StringMessage> ToMessage(std::int64_t stamp_ns,
                                             const DescriptionMeasurement& description);
// Points that were met, one after the other: x, y, z and time as floats, and the layer as ring.
[[nodiscard]] Owned<PointCloudMessage> ToMessage(std::int64_t stamp_ns,
                                                 const CloudMeasurement& cloud);
[[nodiscard]] Owned<RangeMessage> ToMessage(std::int64_t stamp_ns, const RangeMeasurement& range);
// 32FC1, in metres.
[[nodiscard]] Owned<ImageMessage> ToMessage(std::int64_t stamp_ns, const DepthMeasurement& depth);
[[nodiscard]] Owned<NavSatFixMessage> ToMessage(std::int64_t stamp_ns, const GnssMeasurement& gnss);
[[nodiscard]] Owned<MagneticFieldMessage> ToMessage(std::int64_t stamp_ns,
                                                    const MagneticMeasurement& magnetic);
[[nodiscard]] Owned<FluidPressureMessage> ToMessage(std::int64_t stamp_ns,
                                                    const PressureMeasurement& pressure);
[[nodiscard]] Owned<BoolMessage> ToMessage(std::int64_t stamp_ns,
                                           const ContactMeasurement& contact);

// The message for the measurement, which must not be empty.
[[nodiscard]] SensorMessage MessageOf(const Measurement& measurement);
// The bytes of the measurement's message, as that release has it. The measurement must not be
// empty.
[[nodiscard]] std::vector<std::byte> EncodeMeasurement(std::int64_t stamp_ns,
                                                       const Measurement& measurement,
                                                       RosRelease release);

}  // namespace tcs::dds
