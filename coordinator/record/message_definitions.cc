#include "coordinator/record/message_definitions.h"

#include <algorithm>
#include <set>

namespace tcs::record {
namespace {

// A field's type without a package is of the message's own package.
constexpr MessageFields kMessages[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Wrench", "Vector3 force\nVector3 torque\n"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\nTransform transform\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance\n"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort\n"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
     "float32[] ranges\nfloat32[] intensities\n"},
    {"sensor_msgs/Range",
     "uint8 ULTRASOUND=0\nuint8 INFRARED=1\n"
     "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n"
     "float32 max_range\nfloat32 range\nfloat32 variance\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
     "uint8 FLOAT32=7\nuint8 FLOAT64=8\n"
     "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/NavSatStatus",
     "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\n"
     "int8 status\nuint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\n"
     "uint16 SERVICE_GALILEO=8\nuint16 service\n"},
    {"sensor_msgs/NavSatFix",
     "std_msgs/Header header\nNavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
     "float64 altitude\nfloat64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN=0\n"
     "uint8 COVARIANCE_TYPE_APPROXIMATED=1\nuint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\n"
     "uint8 COVARIANCE_TYPE_KNOWN=3\nuint8 position_covariance_type\n"},
    {"sensor_msgs/MagneticField",
     "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\n"
     "float64[9] magnetic_field_covariance\n"},
    {"sensor_msgs/FluidPressure",
     "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
     "uint32 step\nuint8[] data\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"std_msgs/Bool", "bool data\n"},
    {"std_msgs/String", "string data\n"},
    {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n"},
    {"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset\n"},
    {"std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"trajectory_msgs/JointTrajectoryPoint",
     "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n"
     "builtin_interfaces/Duration time_from_start\n"},
    {"trajectory_msgs/JointTrajectory",
     "std_msgs/Header header\nstring[] joint_names\nJointTrajectoryPoint[] points\n"},
};

const MessageFields* Find(std::string_view type) {
  const auto* const found =
      std::ranges::find_if(kMessages, [type](const auto& message) { return message.type == type; });
  return found == std::end(kMessages) ? nullptr : found;
}

// The messages that a message's fields are of, in alphabetical order, as rosbag2 has them.
std::set<std::string> PartsOf(const MessageFields& message) {
  const std::string package(message.type.substr(0, message.type.find('/') + 1));
  std::set<std::string> parts;
  for (std::string_view rest = message.text; !rest.empty();) {
    const std::string name(rest.substr(0, rest.find_first_of(" [")));
    rest.remove_prefix(rest.find('\n') + 1);
    for (const std::string& type : {package + name, name}) {
      if (Find(type) != nullptr) parts.insert(type);
    }
  }
  return parts;
}

void Append(const MessageFields& message, std::set<std::string>* written, std::string* text) {
  *text += message.text;
  for (const std::string& part : PartsOf(message)) {
    if (!written->insert(part).second) continue;
    *text += '\n' + std::string(80, '=') + "\nMSG: " + part + '\n';
    Append(*Find(part), written, text);
  }
}

}  // namespace

std::span<const MessageFields> KnownMessages() { return kMessages; }

std::string DefinitionOf(std::string_view type, dds::RosRelease release) {
  constexpr std::string_view kFolder = "/msg/";
  const std::size_t at = type.find(kFolder);
  if (at == std::string_view::npos) return {};
  const std::string name =
      std::string(type.substr(0, at + 1)) + std::string(type.substr(at + kFolder.size()));
  const MessageFields* message = Find(name);
  std::string text;
  std::set<std::string> written;
  if (message != nullptr) Append(*message, &written, &text);
  // What Iron added.
  constexpr std::string_view kVariance = "float32 variance\n";
  if (name == "sensor_msgs/Range" && release == dds::RosRelease::kHumble) {
    text.erase(text.find(kVariance), kVariance.size());
  }
  return text;
}

}  // namespace tcs::record
