#include "coordinator/scenario/load_joints.h"

#include <algorithm>
#include <utility>

#include "coordinator/scenario/nearest.h"

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

// Joints are numbered through the world: those of the first model first.
int FirstJointOf(std::size_t model, const Scenario& scenario) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < model; ++i) first += scenario.world->models[i].joints.size();
  return static_cast<int>(first);
}

// The other way round.
template <class Models>
auto& JointOf(int index, Models& models) {
  auto joint = static_cast<std::size_t>(index);
  std::size_t model = 0;
  while (joint >= models[model].joints.size()) joint -= models[model++].joints.size();
  return models[model].joints[joint];
}

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

JointGroup LoadGroup(const YamlMap& map, const Scenario& scenario, Use use) {
  const YamlValue& model_value = map.Require("model", "model: arm");
  const std::size_t index = FindModel(model_value, scenario);
  const RobotModel& model = scenario.world->models[index];
  const int first = FirstJointOf(index, scenario);
  JointGroup group{model.name, {}, {}};
  const auto add = [&](std::size_t joint) {
    group.joints.push_back(first + static_cast<int>(joint));
    group.names.push_back(model.joints[joint].name);
  };
  if (const YamlValue* joints = map.Find("joints")) {
    for (const YamlValue& value : joints->AsList("[shoulder, elbow]")) {
      const std::size_t joint = FindJoint(value, model, use);
      if (std::ranges::find(group.names, model.joints[joint].name) != group.names.end()) {
        value.Fail("names the joint '" + value.AsText() + "' a second time; remove it");
      }
      add(joint);
    }
    return group;
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (Suits(model.joints[i], use)) add(i);
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
    value.Fail("is the unknown '" + text + "'; " +
               Suggest(text, {kJointQuantities.begin(), kJointQuantities.end()}, "quantities"));
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

JointDriveSpec LoadJointDrive(const YamlMap& map, const Scenario& scenario) {
  JointDriveSpec spec;
  spec.group = LoadGroup(map, scenario, Use::kDrive);
  const std::size_t count = spec.group.joints.size();
  spec.gains.resize(count);
  if (const YamlValue* drive = map.Find("drive")) spec.quantity = LoadQuantity(*drive);
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
