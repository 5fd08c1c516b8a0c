#include "coordinator/dds/measurement_messages.h"

#include <algorithm>
#include <type_traits>

#include "coordinator/dds/ros_fields.h"

namespace tcs::dds {

Owned<ImuMessage> ToMessage(std::int64_t stamp_ns, const ImuMeasurement& measured) {
  Owned<ImuMessage> imu;
  SetHeader(&imu->header, stamp_ns, measured.frame);
  imu->orientation = ToQuaternion(measured.orientation_xyzw);
  imu->angular_velocity = ToVector3(measured.felt.angular_rate_radps);
  if (measured.felt.proper_acceleration_mps2.has_value()) {
    imu->linear_acceleration = ToVector3(*measured.felt.proper_acceleration_mps2);
  } else {
    imu->linear_acceleration_covariance[0] = -1;
  }
  return imu;
}

Owned<OdometryMessage> ToMessage(std::int64_t stamp_ns, const OdometryMeasurement& measured) {
  Owned<OdometryMessage> odometry;
  SetHeader(&odometry->header, stamp_ns, measured.frame);
  SetText(&odometry->child_frame_id, measured.child_frame);
  const auto& [x, y, z] = measured.pose.position_m;
  odometry->pose.pose = {{x, y, z}, ToQuaternion(measured.pose.orientation_xyzw)};
  odometry->twist.twist = {ToVector3(measured.linear_mps), ToVector3(measured.angular_radps)};
  return odometry;
}

Owned<LaserScanMessage> ToMessage(std::int64_t stamp_ns, const ScanMeasurement& measured) {
  Owned<LaserScanMessage> scan;
  const auto last = static_cast<double>(measured.ranges_m.size()) - 1;
  SetHeader(&scan->header, stamp_ns, measured.frame);
  scan->angle_min = static_cast<float>(measured.first_rad);
  scan->angle_max = static_cast<float>(measured.first_rad + last * measured.step_rad);
  scan->angle_increment = static_cast<float>(measured.step_rad);
  scan->time_increment = static_cast<float>(measured.ray_s);
  scan->scan_time = static_cast<float>(measured.scan_s);
  scan->range_min = static_cast<float>(measured.least_m);
  scan->range_max = static_cast<float>(measured.most_m);
  Resize(&scan->ranges, measured.ranges_m.size());
  std::transform(measured.ranges_m.begin(), measured.ranges_m.end(), scan->ranges._buffer,
                 [](double range_m) { return static_cast<float>(range_m); });
  return scan;
}

std::vector<std::byte> EncodeMeasurement(std::int64_t stamp_ns, const Measurement& measurement) {
  return std::visit(
      [stamp_ns](const auto& measured) -> std::vector<std::byte> {
        if constexpr (std::is_same_v<decltype(measured), const std::monostate&>) {
          TCS_CHECK(false);
          return {};
        } else {
          return ToCdr(ToMessage(stamp_ns, measured));
        }
      },
      measurement);
}

}  // namespace tcs::dds
