#include "coordinator/scenario/load_joints.h"

#include <algorithm>
#include <utility>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/sections.h"

namespace tcs {

std::size_t FindModel(const YamlValue& value, const Scenario& scenario) {
  const std::string name = value.AsText();
  const std::vector<RobotModel>& models = scenario.world->models;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].name == name) return i;
    known.push_back(models[i].name);
  }
  if (known.empty()) {
    value.Fail("names the model '" + name + "', but the scenario has none that moves; add models");
  }
  value.Fail("names the unknown model '" + name + "'; " + Suggest(name, known, "models"));
}

namespace {

// Joints are numbered through the world: the joints of the first model come first.
int FirstJointOf(std::size_t model, const Scenario& scenario) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < model; ++i) first += scenario.world->models[i].joints.size();
  return static_cast<int>(first);
}

// The joint of that number in the world.
template <class Models>
auto& JointOf(int index, Models& models) {
  auto joint = static_cast<std::size_t>(index);
  std::size_t model = 0;
  while (joint >= models[model].joints.size()) joint -= models[model++].joints.size();
  return models[model].joints[joint];
}

constexpr const char* kDifferential = "differential";
constexpr const char* kTrajectory = "trajectory";

enum class Use { kRead, kDrive };

bool Suits(const Joint& joint, Use use) {
  return CoordinatesOf(joint.kind) == 1 && (use == Use::kRead || !joint.mimic.has_value());
}

std::size_t FindJoint(const YamlValue& value, const RobotModel& model, Use use) {
  const std::string name = value.AsText();
  std::vector<std::string> known;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (joint.name == name && CoordinatesOf(joint.kind) != 1) {
      value.Fail("names the joint '" + name + "', which has " +
                 std::to_string(CoordinatesOf(joint.kind)) +
                 " coordinates; channels are about joints with one");
    }
    if (joint.name == name && !Suits(joint, use)) {
      value.Fail("names the joint '" + name + "', which follows another one; drive that one");
    }
    if (joint.name == name) return i;
    if (Suits(joint, use)) known.push_back(joint.name);
  }
  value.Fail("names the unknown joint '" + name + "' of " + model.name + "; " +
             Suggest(name, known, "joints"));
}

// Appends the joint that `value` names, or the joints of the list that `value` is.
void AddNamed(const YamlValue& value, const RobotModel& model, int first, Use use,
              JointGroup* group) {
  if (value.IsList()) {
    for (const YamlValue& each : value.AsList("[shoulder, elbow]")) {
      AddNamed(each, model, first, use, group);
    }
    return;
  }
  const std::size_t joint = FindJoint(value, model, use);
  if (std::ranges::find(group->names, model.joints[joint].name) != group->names.end()) {
    value.Fail("names the joint '" + value.AsText() + "' a second time; remove it");
  }
  group->joints.push_back(first + static_cast<int>(joint));
  group->names.push_back(model.joints[joint].name);
}

JointGroup LoadGroup(const YamlMap& map, const Scenario& scenario, Use use) {
  const YamlValue& model_value = map.Require("model", "model: arm");
  const std::size_t index = FindModel(model_value, scenario);
  const RobotModel& model = scenario.world->models[index];
  const int first = FirstJointOf(index, scenario);
  JointGroup group{model.name, {}, {}, {}};
  for (const Joint& joint : model.joints) {
    if (use == Use::kDrive && joint.mimic.has_value()) group.followers.push_back(joint.name);
  }
  if (const YamlValue* joints = map.Find("joints")) {
    for (const YamlValue& value : joints->AsList("[shoulder, elbow]")) {
      AddNamed(value, model, first, use, &group);
    }
    return group;
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (!Suits(model.joints[i], use)) continue;
    group.joints.push_back(first + static_cast<int>(i));
    group.names.push_back(model.joints[i].name);
  }
  if (group.joints.empty()) {
    model_value.Fail("is " + model.name + ", which has no joints with one coordinate");
  }
  return group;
}

// A number for all joints, or one for each of those that are named.
std::vector<double> LoadGains(const YamlValue& value, std::size_t joints) {
  if (!value.IsList()) return std::vector<double>(joints, value.AsNonNegativeNumber(""));
  std::vector<double> gains = value.AsNumbers(joints, "[100, 50], one for each joint");
  for (const double gain : gains) {
    if (gain < 0) value.Fail("has a number below 0, which would drive a joint away");
  }
  return gains;
}

JointQuantity LoadQuantity(const YamlValue& value) {
  const std::string text = value.AsText();
  const auto found = std::ranges::find(kJointQuantities, text);
  if (found == kJointQuantities.end()) {
    std::vector<std::string> known(kJointQuantities.begin(), kJointQuantities.end());
    known.insert(known.end(), {kDifferential, kTrajectory});
    value.Fail("is the unknown '" + text + "'; " + Suggest(text, known, "drives"));
  }
  return static_cast<JointQuantity>(found - kJointQuantities.begin());
}

}  // namespace

bool IsOfModel(const YamlMap& map, const char* body_key) {
  const YamlValue* model = map.Find("model");
  if (model != nullptr && map.Find(body_key) != nullptr) {
    model->Fail(std::string("cannot be given beside ") + body_key + "; make two channels of it");
  }
  return model != nullptr;
}

JointGroup LoadJointGroup(const YamlMap& map, const Scenario& scenario) {
  return LoadGroup(map, scenario, Use::kRead);
}

namespace {

bool Drives(const YamlMap& map, const char* what) {
  const YamlValue* drive = map.Find("drive");
  return drive != nullptr && drive->AsText() == what;
}

// Wheels that nobody limits turn as fast as their servos make them.
double LimitOf(const JointGroup& wheels, const RobotModel& model, int first) {
  double most_radps = kNoLimit;
  for (const int joint : wheels.joints) {
    most_radps =
        std::min(most_radps, model.joints[static_cast<std::size_t>(joint - first)].limits.velocity);
  }
  return most_radps;
}

}  // namespace

WheelGroup LoadWheels(const YamlMap& map, const Scenario& scenario) {
  const std::size_t index = FindModel(map.Require("model", "model: rover"), scenario);
  const RobotModel& model = scenario.world->models[index];
  const int first = FirstJointOf(index, scenario);
  WheelGroup wheels;
  wheels.group.model = model.name;
  AddNamed(map.Require("left", "left: left_wheel_joint"), model, first, Use::kDrive, &wheels.group);
  wheels.left = wheels.group.joints.size();
  AddNamed(map.Require("right", "right: right_wheel_joint"), model, first, Use::kDrive,
           &wheels.group);
  wheels.most_radps = LimitOf(wheels.group, model, first);
  return wheels;
}

ModelPlace FindModelPlace(const YamlValue& value, const Scenario& scenario) {
  const std::vector<RobotModel>& models = scenario.world->models;
  const std::size_t index = FindModel(value, scenario);
  std::size_t first = 0;
  for (std::size_t i = 0; i < index; ++i) first += models[i].links.size();
  return {&models[index], static_cast<int>(first)};
}

namespace {

JointDriveSpec LoadWheelDrive(const YamlMap& map, const Scenario& scenario) {
  const WheelGroup wheels = LoadWheels(map, scenario);
  JointDriveSpec spec;
  spec.group = wheels.group;
  spec.quantity = JointQuantity::kVelocity;
  spec.wheels = {.base = LoadWheelBase(map),
                 .left = wheels.left,
                 .most_radps = wheels.most_radps,
                 .timeout = VirtualDuration::Milliseconds(500)};
  if (const YamlValue* v = map.Find("timeout")) spec.wheels->timeout = v->AsDuration();
  const std::vector<double> damping =
      LoadGains(map.Require("damping", "damping: 2"), spec.group.joints.size());
  for (const double gain : damping) spec.gains.push_back({.stiffness = 0, .damping = gain});
  return spec;
}

}  // namespace

std::vector<std::string> JointDriveKeys(const YamlMap& map) {
  if (Drives(map, kDifferential)) {
    return {"model",  "drive",   "left",    "right",  "separation",
            "radius", "damping", "timeout", "latency"};
  }
  std::vector<std::string> keys = {"model",   "joints",  "drive", "stiffness",
                                   "damping", "latency", "lag"};
  if (Drives(map, kTrajectory)) keys.push_back("rate");
  return keys;
}

WheelBase LoadWheelBase(const YamlMap& map) {
  return {map.Require("separation", "separation: 0.35").AsPositiveNumber(" (metres)"),
          map.Require("radius", "radius: 0.08").AsPositiveNumber(" (metres)")};
}

JointDriveSpec LoadJointDrive(const YamlMap& map, const Scenario& scenario) {
  if (Drives(map, kDifferential)) return LoadWheelDrive(map, scenario);
  JointDriveSpec spec;
  spec.group = LoadGroup(map, scenario, Use::kDrive);
  const std::size_t count = spec.group.joints.size();
  spec.gains.resize(count);
  if (Drives(map, kTrajectory)) {
    spec.quantity = JointQuantity::kPosition;
    spec.setpoint_period = VirtualDuration::Milliseconds(10);
    if (const YamlValue* rate = map.Find("rate")) spec.setpoint_period = LoadPeriod(*rate);
  } else if (const YamlValue* drive = map.Find("drive")) {
    spec.quantity = LoadQuantity(*drive);
  }
  if (spec.quantity == JointQuantity::kPosition) map.Require("stiffness", "stiffness: 500");
  if (spec.quantity == JointQuantity::kVelocity) map.Require("damping", "damping: 20");
  if (const YamlValue* v = map.Find("stiffness")) {
    const std::vector<double> gains = LoadGains(*v, count);
    for (std::size_t i = 0; i < count; ++i) spec.gains[i].stiffness = gains[i];
  }
  if (const YamlValue* v = map.Find("damping")) {
    const std::vector<double> gains = LoadGains(*v, count);
    for (std::size_t i = 0; i < count; ++i) spec.gains[i].damping = gains[i];
  }
  if (const YamlValue* v = map.Find("lag")) spec.lag = v->AsDuration();
  for (const int joint : spec.group.joints) {
    spec.limits.push_back(JointOf(joint, scenario.world->models).limits);
  }
  return spec;
}

void SetDriveLag(const YamlMap& map, const JointDriveSpec& spec, Scenario* scenario) {
  const YamlValue* lag = map.Find("lag");
  const YamlValue& place = lag != nullptr ? *lag : map.place();
  for (std::size_t i = 0; i < spec.group.joints.size(); ++i) {
    const int joint = spec.group.joints[i];
    for (const CommandChannelSpec& other : scenario->commands) {
      if (!other.joints || other.joints->lag == spec.lag) continue;
      if (std::ranges::find(other.joints->group.joints, joint) ==
          other.joints->group.joints.end()) {
        continue;
      }
      place.Fail("drives the joint '" + spec.group.names[i] + "' with another lag than channel " +
                 other.name + " does; a joint has one");
    }
    JointOf(joint, scenario->world->models).drive_lag = spec.lag;
  }
}

}  // namespace tcs
