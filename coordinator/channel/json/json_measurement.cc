#include "coordinator/channel/json/json_measurement.h"

#include <cmath>

#include "coordinator/channel/json/json_text.h"
#include "shm/check.h"

namespace tcs {
namespace {

struct Encode {
  JsonObject& json;

  void operator()(const std::monostate&) const { TCS_CHECK(false); }

  void operator()(const ImuMeasurement& imu) const {
    json.Add("frame_id", imu.frame);
    json.Add("orientation", imu.orientation_xyzw);
    json.Add("angular_rate", imu.felt.angular_rate_radps);
    if (imu.felt.proper_acceleration_mps2.has_value()) {
      json.Add("proper_acceleration", *imu.felt.proper_acceleration_mps2);
    } else {
      json.AddRaw("proper_acceleration", "null");
    }
  }

  void operator()(const OdometryMeasurement& odometry) const {
    json.Add("frame_id", odometry.frame);
    json.Add("child_frame_id", odometry.child_frame);
    json.Add("position", odometry.pose.position_m);
    json.Add("orientation", odometry.pose.orientation_xyzw);
    json.Add("linear_velocity", odometry.linear_mps);
    json.Add("angular_velocity", odometry.angular_radps);
  }

  void operator()(const ScanMeasurement& scan) const {
    json.Add("frame_id", scan.frame);
    json.Add("angle_min", scan.first_rad);
    json.Add("angle_increment", scan.step_rad);
    json.Add("time_increment", scan.ray_s);
    json.Add("scan_time", scan.scan_s);
    json.Add("range_min", scan.least_m);
    json.Add("range_max", scan.most_m);
    json.Add("ranges", InJson(scan.ranges_m));
  }

  void operator()(const TransformsMeasurement& measured) const {
    std::string list = "[";
    for (const auto& [frame, child_frame, pose] : measured.transforms) {
      if (list.size() > 1) list += ',';
      JsonObject transform;
      transform.Add("frame_id", frame);
      transform.Add("child_frame_id", child_frame);
      transform.Add("translation", pose.position_m);
      transform.Add("rotation", pose.orientation_xyzw);
      list += transform.Take();
    }
    json.AddRaw("transforms", list + "]");
  }

  void operator()(const DescriptionMeasurement& description) const {
    json.Add("data", description.text);
  }

  void operator()(const CloudMeasurement& cloud) const {
    std::string list = "[";
    for (const CloudMeasurement::Point& point : cloud.points) {
      if (list.size() > 1) list += ',';
      std::array<double, 3> at = point.direction;
      for (double& axis : at) axis *= point.range_m;
      AppendList(at, list);
    }
    json.Add("frame_id", cloud.frame);
    json.AddRaw("points", list + "]");
  }

  void operator()(const RangeMeasurement& range) const {
    json.Add("frame_id", range.frame);
    json.Add("field_of_view", range.field_of_view_rad);
    json.Add("range_min", range.least_m);
    json.Add("range_max", range.most_m);
    json.Add("range", InJson(range.range_m));
  }

  void operator()(const DepthMeasurement& depth) const {
    json.Add("frame_id", depth.frame);
    json.AddRaw("width", std::to_string(depth.width));
    json.AddRaw("height", std::to_string(depth.height));
    json.Add("depths", InJson(depth.depths_m));
  }

  void operator()(const GnssMeasurement& gnss) const {
    const Geodetic position = gnss.position();
    json.Add("frame_id", gnss.frame);
    json.Add("latitude", position.latitude_deg);
    json.Add("longitude", position.longitude_deg);
    json.Add("altitude", position.altitude_m);
  }

  void operator()(const MagneticMeasurement& magnetic) const {
    json.Add("frame_id", magnetic.frame);
    json.Add("magnetic_field", magnetic.field_t);
  }

  void operator()(const PressureMeasurement& pressure) const {
    json.Add("frame_id", pressure.frame);
    json.Add("pressure", pressure.pressure_pa);
  }

  void operator()(const ContactMeasurement& contact) const {
    json.Add("frame_id", contact.frame);
    json.AddRaw("touches", contact.is_touching ? "true" : "false");
  }

  // JSON has no infinity: a range that is too far is null, and a range that is too near is 0.
  static double InJson(double range_m) { return range_m < 0 && std::isinf(range_m) ? 0 : range_m; }
  static std::vector<double> InJson(std::vector<double> ranges_m) {
    for (double& range_m : ranges_m) range_m = InJson(range_m);
    return ranges_m;
  }
};

}  // namespace

std::string EncodeMeasurement(const Reading& reading) {
  JsonObject json(reading.at);
  std::visit(Encode{json}, reading.measured);
  return json.Take();
}

}  // namespace tcs
