#include "coordinator/scenario/load_instruments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "coordinator/errors/nearest.h"
#include "coordinator/models/file_text.h"
#include "coordinator/models/model_mistake.h"
#include "coordinator/scenario/load_joints.h"
#include "coordinator/scenario/load_rays.h"
#include "coordinator/scenario/load_sensing.h"

namespace tcs {
namespace {

// A number and its comma take 20 bytes at most, and a datagram has 65507.
constexpr std::size_t kMostRaysOfDatagram = 3000;
constexpr std::size_t kMostDescription = 4 << 20;  // as that of a robot's file

InstrumentSpec LoadImu(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  return ImuSpec{LoadMount(map, scenario)};
}

InstrumentSpec LoadTruth(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  TruthSpec truth{LoadMount(map, scenario)};
  if (const YamlValue* v = map.Find("world_frame")) truth.world_frame = v->AsText();
  return truth;
}

InstrumentSpec LoadWheelOdometry(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  const WheelGroup wheels = LoadWheels(map, scenario);
  WheelOdometrySpec odometry{wheels.group.joints, wheels.left, LoadWheelBase(map)};
  if (const YamlValue* v = map.Find("frame")) odometry.frame = v->AsText();
  if (const YamlValue* v = map.Find("child_frame")) odometry.child_frame = v->AsText();
  return odometry;
}

// The places of the model's joints that move, or of those that do not move.
TransformsSpec LoadPairs(const YamlMap& map, const Scenario& scenario, bool of_fixed) {
  const YamlValue& value = map.Require("model", "model: rover");
  const ModelPlace place = FindModelPlace(value, scenario);
  std::string prefix;
  if (const YamlValue* v = map.Find("prefix")) prefix = v->AsText();
  const auto frame = [&](int link) {
    return prefix + place.model->links[static_cast<std::size_t>(link)].name;
  };
  TransformsSpec transforms;
  if (const YamlValue* v = map.Find("world_frame")) {
    const int root = place.model->root;
    transforms.pairs.push_back({-1, place.first_link + root, v->AsText(), frame(root)});
  }
  for (const Joint& joint : place.model->joints) {
    if ((joint.kind == JointKind::kFixed) != of_fixed) continue;
    transforms.pairs.push_back({place.first_link + joint.parent, place.first_link + joint.child,
                                frame(joint.parent), frame(joint.child)});
  }
  if (transforms.pairs.empty()) {
    value.Fail("is " + place.model->name + ", which has no joint that is " +
               (of_fixed ? "fixed" : "not fixed; name its root's frame with world_frame: world"));
  }
  return transforms;
}

InstrumentSpec LoadTransforms(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  return LoadPairs(map, scenario, false);
}

InstrumentSpec LoadFixedTransforms(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  return FixedTransformsSpec{LoadPairs(map, scenario, true)};
}

InstrumentSpec LoadDescription(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  const YamlValue& value = map.Require("model", "model: rover");
  const ModelPlace place = FindModelPlace(value, scenario);
  const auto file = scenario.urdf_files.find(place.model->name);
  if (file == scenario.urdf_files.end()) {
    value.Fail("is " + place.model->name + ", which comes from no file; name one that has a urdf");
  }
  const auto expanded = scenario.urdf_expanded.find(place.model->name);
  if (expanded != scenario.urdf_expanded.end()) return DescriptionSpec{expanded->second};
  try {
    return DescriptionSpec{TextOf(file->second, kMostDescription, "a URDF file")};
  } catch (const ModelMistake& mistake) {
    value.FailPlainly(mistake.message);
  }
}

InstrumentSpec LoadGnss(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  GnssSpec gnss{LoadMount(map, scenario)};
  const YamlValue& value = map.Require("origin", "origin: [52.52, 13.405, 34] (degrees, metres)");
  const std::vector<double> origin = value.AsNumbers(3, "[52.52, 13.405, 34] (degrees, metres)");
  if (std::abs(origin[0]) > 90 || std::abs(origin[1]) > 180) {
    value.Fail("is not on the earth; give latitude and longitude in degrees, and the altitude");
  }
  gnss.origin = {origin[0], origin[1], origin[2]};
  return gnss;
}

InstrumentSpec LoadMagnetometer(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  MagnetometerSpec magnetometer{LoadMount(map, scenario)};
  if (const YamlValue* v = map.Find("field")) magnetometer.field_t = v->AsVector3();
  return magnetometer;
}

InstrumentSpec LoadBarometer(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  BarometerSpec barometer{LoadMount(map, scenario)};
  if (const YamlValue* v = map.Find("ground")) {
    barometer.ground_pa = v->AsPositiveNumber(" (pascals)");
  }
  return barometer;
}

InstrumentSpec LoadContact(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  ContactSpec contact{LoadMount(map, scenario)};
  if (const YamlValue* v = map.Find("margin")) {
    contact.margin_m = v->AsNonNegativeNumber(" (metres)");
  }
  return contact;
}

using enum MeasuredField;

struct Kind {
  const char* name;
  std::vector<std::string> keys;  // beside those of all sensors
  std::vector<MeasuredField> fields;
  std::function<InstrumentSpec(const YamlMap&, const Scenario&, VirtualDuration period)> load;
  dds::SensorMessage message;
  bool is_said_once = false;     // at the start
  const char* topic = "";        // where nothing else is said
  bool has_much_to_say = false;  // too much for JSON
};

const std::vector<Kind>& Kinds() {
  const std::vector<MeasuredField> motion = {kPosition, kOrientation, kLinearVelocity,
                                             kAngularVelocity};
  using enum dds::SensorMessage;
  static const std::vector<Kind> kinds = {
      {"imu",
       {"on", "at", "frame"},
       {MeasuredField::kOrientation, kAngularRate, kProperAcceleration},
       LoadImu,
       kImu},
      {"odometry", {"on", "at", "frame", "world_frame"}, motion, LoadTruth, kOdometry},
      {"wheel_odometry",
       {"model", "left", "right", "separation", "radius", "frame", "child_frame"},
       motion,
       LoadWheelOdometry,
       kOdometry},
      {"transforms",
       {"model", "world_frame", "prefix"},
       {},
       LoadTransforms,
       dds::SensorMessage::kTransforms,
       false,
       "/tf"},
      {"fixed_transforms",
       {"model", "prefix"},
       {},
       LoadFixedTransforms,
       dds::SensorMessage::kTransforms,
       true,
       "/tf_static"},
      {"description", {"model"}, {}, LoadDescription, kString, true, "/robot_description", true},
      {"lidar",
       {"on", "at", "frame", "rays", "angles", "range", "sweep"},
       {MeasuredField::kRange},
       LoadLidar,
       kLaserScan},
      {"lidar_3d",
       {"on", "at", "frame", "rays", "angles", "range", "sweep", "layers", "elevations"},
       {MeasuredField::kRange},
       LoadLidar3d,
       kPointCloud,
       false,
       "",
       true},
      {"range",
       {"on", "at", "frame", "range", "field_of_view", "radiation"},
       {MeasuredField::kRange},
       LoadRange,
       dds::SensorMessage::kRange},
      {"depth_camera",
       {"on", "at", "frame", "range", "field_of_view", "width", "height"},
       {MeasuredField::kRange},
       LoadDepthCamera,
       kImage,
       false,
       "",
       true},
      {"gnss", {"on", "at", "frame", "origin"}, {kPosition}, LoadGnss, kNavSatFix},
      {"magnetometer",
       {"on", "at", "frame", "field"},
       {MeasuredField::kMagneticField},
       LoadMagnetometer,
       dds::SensorMessage::kMagneticField},
      {"barometer", {"on", "at", "frame", "ground"}, {kPressure}, LoadBarometer, kFluidPressure},
      {"contact", {"on", "frame", "margin"}, {}, LoadContact, kBool},
  };
  return kinds;
}

const char* NameOfField(MeasuredField field) {
  constexpr std::array<const char*, kMeasuredFields> kNames = {
      "orientation",      "angular_rate", "proper_acceleration", "position", "linear_velocity",
      "angular_velocity", "range",        "magnetic_field",      "pressure"};
  return kNames[static_cast<std::size_t>(field)];
}

const Kind& KindOf(const YamlMap& map) {
  const YamlValue& value = *map.Find("kind");
  const std::string name = value.AsText();
  std::vector<std::string> known;
  for (const Kind& kind : Kinds()) {
    if (name == kind.name) return kind;
    known.push_back(kind.name);
  }
  value.Fail("is the unknown '" + name + "'; " + Suggest(name, known, "kinds of sensors"));
}

bool IsNumber(MeasuredField field) { return field == MeasuredField::kRange || field == kPressure; }

}  // namespace

bool IsAboutInstrument(const YamlMap& map) { return map.Find("kind") != nullptr; }

std::vector<std::string> InstrumentKeys(const YamlMap& map) {
  const Kind& kind = KindOf(map);
  std::vector<std::string> keys = {"kind", "latency"};
  if (!kind.is_said_once) keys.insert(keys.end(), {"rate", "dropout", "jitter"});
  keys.insert(keys.end(), kind.keys.begin(), kind.keys.end());
  if (!kind.fields.empty()) keys.insert(keys.end(), {"noise", "bias"});
  return keys;
}

void LoadInstrument(const YamlMap& map, const Scenario& scenario, SensorChannelSpec* channel) {
  const Kind& kind = KindOf(map);
  if (kind.is_said_once) channel->period = {};
  channel->instrument = kind.load(map, scenario, channel->period);
  std::vector<NamedError> errors;
  for (const MeasuredField field : kind.fields) {
    errors.push_back({NameOfField(field),
                      &channel->measurement_errors[static_cast<std::size_t>(field)],
                      IsNumber(field)});
  }
  LoadFieldErrors(map, errors);
}

void CheckFitsDatagram(const YamlMap& map, const InstrumentSpec& spec) {
  if (KindOf(map).has_much_to_say) {
    map.Find("kind")->Fail("tells more than JSON is for; make the channel's type dds");
  }
  const auto* lidar = std::get_if<LidarSpec>(&spec);
  if (lidar != nullptr && lidar->rays > kMostRaysOfDatagram) {
    map.Find("rays")->Fail("makes more than fits into a datagram; cast " +
                           std::to_string(kMostRaysOfDatagram) +
                           " at most, or make the channel's type dds");
  }
}

dds::SensorMessage MessageOf(const YamlMap& map) { return KindOf(map).message; }

DdsTopicSpec DefaultEndOf(const YamlMap& map) {
  const Kind& kind = KindOf(map);
  DdsTopicSpec end{.topic = kind.topic, .domain = 0, .qos = {}};
  if (kind.is_said_once) {
    end.qos.durability = dds::Durability::kTransientLocal;
    end.qos.depth = 1;
  }
  return end;
}

}  // namespace tcs
