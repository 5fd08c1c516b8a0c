#include "coordinator/dds/measurement_messages.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <type_traits>
#include <variant>

#include "coordinator/dds/ros_fields.h"

namespace tcs::dds {

Owned<ImuMessage> ToMessage(std::int64_t stamp_ns, const ImuMeasurement& measured) {
  Owned<ImuMessage> imu;
  SetHeader(&imu->header, stamp_ns, measured.frame);
  imu->orientation = ToQuaternion(measured.orientation_xyzw);
  imu->angular_velocity = ToVector3(measured.felt.angular_rate_radps);
  SetDiagonal(imu->orientation_covariance, measured.orientation_variance);
  SetDiagonal(imu->angular_velocity_covariance, measured.rate_variance);
  if (measured.felt.proper_acceleration_mps2.has_value()) {
    imu->linear_acceleration = ToVector3(*measured.felt.proper_acceleration_mps2);
    SetDiagonal(imu->linear_acceleration_covariance, measured.acceleration_variance);
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
  SetDiagonal(odometry->pose.covariance, measured.position_variance, measured.orientation_variance);
  SetDiagonal(odometry->twist.covariance, measured.linear_variance, measured.angular_variance);
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

Owned<TransformsMessage> ToMessage(std::int64_t stamp_ns, const TransformsMeasurement& measured) {
  Owned<TransformsMessage> message;
  Resize(&message->transforms, measured.transforms.size());
  for (std::size_t i = 0; i < measured.transforms.size(); ++i) {
    const auto& [frame, child_frame, pose] = measured.transforms[i];
    auto& transform = message->transforms._buffer[i];
    SetHeader(&transform.header, stamp_ns, frame);
    SetText(&transform.child_frame_id, child_frame);
    transform.transform = {ToVector3(pose.position_m), ToQuaternion(pose.orientation_xyzw)};
  }
  return message;
}

Owned<StringMessage> ToMessage(std::int64_t, const DescriptionMeasurement& measured) {
  Owned<StringMessage> message;
  SetText(&message->data, measured.text);
  return message;
}

namespace {

// The numbers of PointField's types.
constexpr std::uint8_t kFloat32 = 7, kUint16 = 4;

struct CloudField {
  const char* name;
  std::uint8_t type;
  std::uint32_t offset;
};
constexpr CloudField kCloudFields[] = {{"x", kFloat32, 0},
                                       {"y", kFloat32, 4},
                                       {"z", kFloat32, 8},
                                       {"time", kFloat32, 12},
                                       {"ring", kUint16, 16}};
constexpr std::uint32_t kPointBytes = 18;

template <class Value>
void Put(Value value, std::uint8_t** to) {
  std::memcpy(*to, &value, sizeof value);
  *to += sizeof value;
}

}  // namespace

Owned<PointCloudMessage> ToMessage(std::int64_t stamp_ns, const CloudMeasurement& measured) {
  Owned<PointCloudMessage> cloud;
  const auto points = static_cast<std::uint32_t>(measured.points.size());
  SetHeader(&cloud->header, stamp_ns, measured.frame);
  cloud->height = 1;
  cloud->width = points;
  Resize(&cloud->fields, std::size(kCloudFields));
  for (std::size_t i = 0; i < std::size(kCloudFields); ++i) {
    auto& field = cloud->fields._buffer[i];
    SetText(&field.name, kCloudFields[i].name);
    field.offset = kCloudFields[i].offset;
    field.datatype = kCloudFields[i].type;
    field.count = 1;
  }
  cloud->point_step = kPointBytes;
  cloud->row_step = kPointBytes * points;
  cloud->is_dense = true;
  Resize(&cloud->data, std::size_t{kPointBytes} * points);
  std::uint8_t* to = cloud->data._buffer;
  for (const CloudMeasurement::Point& point : measured.points) {
    for (const double axis : point.direction) Put(static_cast<float>(axis * point.range_m), &to);
    Put(static_cast<float>(point.after_s), &to);
    Put(point.layer, &to);
  }
  return cloud;
}

Owned<RangeMessage> ToMessage(std::int64_t stamp_ns, const RangeMeasurement& measured) {
  Owned<RangeMessage> range;
  SetHeader(&range->header, stamp_ns, measured.frame);
  range->radiation_type = measured.is_infrared ? 1 : 0;
  range->field_of_view = static_cast<float>(measured.field_of_view_rad);
  range->min_range = static_cast<float>(measured.least_m);
  range->max_range = static_cast<float>(measured.most_m);
  range->range = static_cast<float>(measured.range_m);
  range->variance = static_cast<float>(measured.range_variance);
  return range;
}

Owned<ImageMessage> ToMessage(std::int64_t stamp_ns, const DepthMeasurement& measured) {
  Owned<ImageMessage> image;
  SetHeader(&image->header, stamp_ns, measured.frame);
  image->height = static_cast<std::uint32_t>(measured.height);
  image->width = static_cast<std::uint32_t>(measured.width);
  SetText(&image->encoding, "32FC1");
  image->step = image->width * static_cast<std::uint32_t>(sizeof(float));
  Resize(&image->data, measured.depths_m.size() * sizeof(float));
  std::uint8_t* to = image->data._buffer;
  for (const double depth_m : measured.depths_m) Put(static_cast<float>(depth_m), &to);
  return image;
}

Owned<NavSatFixMessage> ToMessage(std::int64_t stamp_ns, const GnssMeasurement& measured) {
  Owned<NavSatFixMessage> fix;
  const Geodetic position = measured.position();
  SetHeader(&fix->header, stamp_ns, measured.frame);
  fix->status.service = 1;  // GPS; the status 0 is a fix
  fix->latitude = position.latitude_deg;
  fix->longitude = position.longitude_deg;
  fix->altitude = position.altitude_m;
  constexpr std::uint8_t kUnknown = 0, kDiagonalKnown = 2;
  SetDiagonal(fix->position_covariance, measured.position_variance);
  fix->position_covariance_type = measured.position_variance > 0 ? kDiagonalKnown : kUnknown;
  return fix;
}

Owned<MagneticFieldMessage> ToMessage(std::int64_t stamp_ns, const MagneticMeasurement& measured) {
  Owned<MagneticFieldMessage> magnetic;
  SetHeader(&magnetic->header, stamp_ns, measured.frame);
  magnetic->magnetic_field = ToVector3(measured.field_t);
  SetDiagonal(magnetic->magnetic_field_covariance, measured.field_variance);
  return magnetic;
}

Owned<FluidPressureMessage> ToMessage(std::int64_t stamp_ns, const PressureMeasurement& measured) {
  Owned<FluidPressureMessage> pressure;
  SetHeader(&pressure->header, stamp_ns, measured.frame);
  pressure->fluid_pressure = measured.pressure_pa;
  pressure->variance = measured.pressure_variance;
  return pressure;
}

Owned<BoolMessage> ToMessage(std::int64_t, const ContactMeasurement& measured) {
  Owned<BoolMessage> contact;
  contact->data = measured.is_touching;
  return contact;
}

SensorMessage MessageOf(const Measurement& measurement) {
  // In the order of Measurement's alternatives, the first of which is none.
  static constexpr SensorMessage kMessages[] = {
      SensorMessage::kImu,           SensorMessage::kOdometry,      SensorMessage::kTransforms,
      SensorMessage::kString,        SensorMessage::kLaserScan,     SensorMessage::kPointCloud,
      SensorMessage::kRange,         SensorMessage::kImage,         SensorMessage::kNavSatFix,
      SensorMessage::kMagneticField, SensorMessage::kFluidPressure, SensorMessage::kBool};
  static_assert(std::size(kMessages) + 1 == std::variant_size_v<Measurement>);
  TCS_CHECK(measurement.index() > 0);
  return kMessages[measurement.index() - 1];
}

std::vector<std::byte> EncodeMeasurement(std::int64_t stamp_ns, const Measurement& measurement,
                                         RosRelease release) {
  return std::visit(
      [&](const auto& measured) -> std::vector<std::byte> {
        using Measured = std::remove_cvref_t<decltype(measured)>;
        if constexpr (std::is_same_v<Measured, std::monostate>) {
          TCS_CHECK(false);
          return {};
        } else {
          std::vector<std::byte> cdr = ToCdr(ToMessage(stamp_ns, measured));
          // Up to Humble a Range ends before its variance.
          if (std::is_same_v<Measured, RangeMeasurement> && release == RosRelease::kHumble) {
            cdr.resize(cdr.size() - sizeof(float));
          }
          return cdr;
        }
      },
      measurement);
}

}  // namespace tcs::dds
