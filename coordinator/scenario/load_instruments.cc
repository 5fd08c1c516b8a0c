#include "coordinator/scenario/load_instruments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "coordinator/scenario/load_joints.h"
#include "coordinator/scenario/load_sensing.h"
#include "coordinator/scenario/load_values.h"
#include "coordinator/scenario/nearest.h"

namespace tcs {
int LoadLink(const YamlValue& value, const Scenario& scenario, std::string* name) {
  const std::string text = value.AsText();
  const std::size_t slash = text.find('/');
  const std::string model_name = text.substr(0, slash);
  int first = 0;
  std::vector<std::string> models;
  for (const RobotModel& model : scenario.world->models) {
    models.push_back(model.name);
    if (model.name != model_name) {
      first += static_cast<int>(model.links.size());
      continue;
    }
    std::vector<std::string> links;
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const Link& link = model.links[i];
      links.push_back(link.name);
      const bool is_root = slash == std::string::npos && static_cast<int>(i) == model.root;
      if (!is_root && (slash == std::string::npos || link.name != text.substr(slash + 1))) continue;
      *name = link.name;
      return first + static_cast<int>(i);
    }
    const std::string link = text.substr(slash + 1);
    value.Fail("names the unknown link '" + link + "' of " + model_name + "; " +
               Suggest(link, links, "links"));
  }
  if (models.empty()) {
    value.Fail("names the model '" + model_name +
               "', but the scenario has none that moves; add models");
  }
  value.Fail("names the unknown model '" + model_name + "'; " +
             Suggest(model_name, models, "models"));
}

namespace {

constexpr std::int64_t kMostRays = 1'000'000;
constexpr double kTurn = 2 * std::numbers::pi;

Mount LoadMount(const YamlMap& map, const Scenario& scenario) {
  Mount mount;
  mount.link = LoadLink(map.Require("on", "on: rover/base_link"), scenario, &mount.frame);
  if (const YamlValue* v = map.Find("at")) {
    const YamlMap at = v->AsMap();
    at.AllowOnly({"position", "orientation"});
    if (const YamlValue* p = at.Find("position")) mount.at.position_m = p->AsVector3();
    if (const YamlValue* q = at.Find("orientation")) {
      mount.at.orientation_xyzw = LoadOrientation(*q);
    }
  }
  if (const YamlValue* v = map.Find("frame")) mount.frame = v->AsText();
  return mount;
}

// [least, most] of what is told of.
void LoadReach(const YamlMap& map, double* least_m, double* most_m) {
  const YamlValue* value = map.Find("range");
  if (value == nullptr) return;
  const std::vector<double> reach = value->AsNumbers(2, "[0.1, 30] (metres)");
  if (reach[0] < 0 || !(reach[1] > reach[0])) {
    value->Fail("is from " + std::to_string(reach[0]) + " to " + std::to_string(reach[1]) +
                " m; give the least and the most distance, like [0.1, 30]");
  }
  *least_m = reach[0];
  *most_m = reach[1];
}

InstrumentSpec LoadImu(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  return ImuSpec{LoadMount(map, scenario)};
}

InstrumentSpec LoadTruth(const YamlMap& map, const Scenario& scenario, VirtualDuration) {
  TruthSpec truth{LoadMount(map, scenario)};
  if (const YamlValue* v = map.Find("world_frame")) truth.world_frame = v->AsText();
  return truth;
}

// From where to where a sensor turns.
void LoadAngles(const YamlValue& value, double* first_rad, double* last_rad) {
  const std::vector<double> angles = value.AsNumbers(2, "[-1.57, 1.57] (radians)");
  if (std::abs(angles[1] - angles[0]) > kTurn + 1e-9) {
    value.Fail("is more than a whole turn (radians)");
  }
  *first_rad = angles[0];
  *last_rad = angles[1];
}

// A sweep that is not said goes at the speed of a whole turn in each period.
VirtualDuration LoadSweep(const YamlMap& map, double angle_rad, VirtualDuration period) {
  const YamlValue* value = map.Find("sweep");
  if (value == nullptr) {
    const double share = std::min(1.0, std::abs(angle_rad) / kTurn);
    return VirtualDuration::Nanoseconds(std::llround(share * static_cast<double>(period.ns())));
  }
  const VirtualDuration sweep = value->AsDuration();
  if (sweep > period) value->Fail("is longer than the time between two scans; make the rate lower");
  return sweep;
}

InstrumentSpec LoadLidar(const YamlMap& map, const Scenario& scenario, VirtualDuration period) {
  LidarSpec lidar{LoadMount(map, scenario)};
  if (const YamlValue* v = map.Find("rays")) {
    lidar.rays = static_cast<std::size_t>(v->AsInteger(1, kMostRays));
  }
  // All round no two rays look the same way.
  lidar.last_rad = lidar.first_rad + kTurn * (1 - 1 / static_cast<double>(lidar.rays));
  if (const YamlValue* v = map.Find("angles")) {
    LoadAngles(*v, &lidar.first_rad, &lidar.last_rad);
  }
  LoadReach(map, &lidar.least_m, &lidar.most_m);
  lidar.sweep = LoadSweep(map, lidar.last_rad - lidar.first_rad, period);
  return lidar;
}

struct Kind {
  const char* name;
  std::vector<std::string> keys;  // beside those of all sensors
  std::vector<MeasuredField> fields;
  std::function<InstrumentSpec(const YamlMap&, const Scenario&, VirtualDuration period)> load;
};

using enum MeasuredField;

const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds = {
      {"imu", {"on", "at", "frame"}, {kOrientation, kAngularRate, kProperAcceleration}, LoadImu},
      {"odometry",
       {"on", "at", "frame", "world_frame"},
       {kPosition, kOrientation, kLinearVelocity, kAngularVelocity},
       LoadTruth},
      {"lidar", {"on", "at", "frame", "rays", "angles", "range", "sweep"}, {kRange}, LoadLidar},
  };
  return kinds;
}

const char* NameOfField(MeasuredField field) {
  constexpr std::array<const char*, kMeasuredFields> kNames = {
      "orientation",      "angular_rate", "proper_acceleration", "position", "linear_velocity",
      "angular_velocity", "range"};
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

}  // namespace

bool IsAboutInstrument(const YamlMap& map) { return map.Find("kind") != nullptr; }

std::vector<std::string> InstrumentKeys(const YamlMap& map) {
  const Kind& kind = KindOf(map);
  std::vector<std::string> keys = {"kind"};
  keys.insert(keys.end(), kind.keys.begin(), kind.keys.end());
  if (!kind.fields.empty()) keys.insert(keys.end(), {"noise", "bias"});
  return keys;
}

void LoadInstrument(const YamlMap& map, const Scenario& scenario, SensorChannelSpec* channel) {
  const Kind& kind = KindOf(map);
  channel->instrument = kind.load(map, scenario, channel->period);
  std::vector<NamedError> errors;
  for (const MeasuredField field : kind.fields) {
    errors.push_back({NameOfField(field),
                      &channel->measurement_errors[static_cast<std::size_t>(field)],
                      field == kRange});
  }
  LoadFieldErrors(map, errors);
}

dds::SensorMessage MessageOf(const InstrumentSpec& spec) {
  constexpr std::array<dds::SensorMessage, std::variant_size_v<InstrumentSpec>> kMessages = {
      dds::SensorMessage::kImu, dds::SensorMessage::kOdometry, dds::SensorMessage::kLaserScan};
  return kMessages[spec.index()];
}

}  // namespace tcs
