#include "coordinator/scenario/load_rotors.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/load_joints.h"
#include "coordinator/scenario/load_values.h"
#include "simbody_bridge/model/rigid_tree.h"

namespace tcs {
namespace {

std::vector<std::string> NamesOf(const auto& parts) {
  std::vector<std::string> names;
  for (const auto& part : parts) names.push_back(part.name);
  return names;
}

// The index among `parts` of the one that `value` names.
int Find(const YamlValue& value, const auto& parts, const std::string& kind,
         const std::string& model) {
  const std::vector<std::string> names = NamesOf(parts);
  const std::string name = value.AsText();
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  if (names.empty()) {
    value.Fail("names the " + kind + " '" + name + "', but " + model + " has none");
  }
  value.Fail("names the unknown " + kind + " '" + name + "' of " + model + "; " +
             Suggest(name, names, kind + "s"));
}

int FirstOf(std::size_t model, const Scenario& scenario, auto parts) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < model; ++i) first += (scenario.world->models[i].*parts).size();
  return static_cast<int>(first);
}

// Puts the rotor on the joint's parent, where the joint is; the thrust goes along the joint's axis,
// or along its z where the joint is fixed.
void MountAt(const Joint& joint, Rotor* rotor) {
  rotor->link = joint.parent;
  rotor->frame = joint.origin;
  if (joint.kind == JointKind::kFixed) return;
  const auto [x, y, z] = joint.axis;
  const double length = std::sqrt(x * x + y * y + z * z);
  const Pose along{{}, FromZTo({x / length, y / length, z / length})};
  rotor->frame = Times(joint.origin, along);
}

void Mount(const YamlMap::Entry& entry, const YamlMap& map, const RobotModel& model, Rotor* rotor) {
  const YamlValue* link = map.Find("link");
  const YamlValue* at = map.Find("at");
  if (link == nullptr) {
    if (at != nullptr) at->Fail("says where on a link it is, but not on which link; add link");
    const auto joint = std::ranges::find(model.joints, entry.key, &Joint::name);
    if (joint == model.joints.end()) {
      entry.value.Fail("does not say where it is; add link: " + model.links[0].name +
                       ", or give it the name of the joint at which it is");
    }
    MountAt(*joint, rotor);
    return;
  }
  rotor->link = Find(*link, model.links, "link", model.name);
  if (at == nullptr) return;
  const YamlMap pose = at->AsMap();
  pose.AllowOnly({"position", "orientation"});
  if (const YamlValue* v = pose.Find("position")) rotor->frame.position_m = v->AsVector3();
  if (const YamlValue* v = pose.Find("orientation")) {
    rotor->frame.orientation_xyzw = LoadOrientation(*v);
  }
}

bool LoadIsClockwise(const YamlValue& value) {
  const std::string way = value.AsText();
  if (way != "cw" && way != "ccw") {
    value.Fail("is the unknown '" + way + "'; " + Suggest(way, {"ccw", "cw"}, "directions"));
  }
  return way == "cw";
}

Rotor LoadRotor(const YamlMap::Entry& entry, const RobotModel& model) {
  const YamlMap map = entry.value.AsMap();
  map.AllowOnly({"link", "at", "thrust", "drag", "direction", "time_constant", "limit"});
  Rotor rotor;
  rotor.name = entry.key;
  Mount(entry, map, model, &rotor);
  rotor.thrust_ns2 =
      map.Require("thrust", "thrust: 8.5e-6").AsNonNegativeNumber(" (N for each (rad/s)^2)");
  if (const YamlValue* v = map.Find("drag")) {
    rotor.drag_nms2 = v->AsNonNegativeNumber(" (N m for each (rad/s)^2)");
    map.Require("direction", "direction: ccw");
  }
  if (const YamlValue* v = map.Find("direction")) rotor.is_clockwise = LoadIsClockwise(*v);
  if (const YamlValue* v = map.Find("time_constant")) rotor.time_constant = v->AsDuration();
  if (const YamlValue* v = map.Find("limit")) rotor.most_radps = v->AsPositiveNumber(" (rad/s)");
  return rotor;
}

bool LoadIsNormalised(const YamlValue& value) {
  const std::string text = value.AsText();
  if (text != "speed" && text != "normalised") {
    value.Fail("is the unknown '" + text + "'; " +
               Suggest(text, {"speed", "normalised"}, "quantities"));
  }
  return text == "normalised";
}

}  // namespace

void LoadRotors(const YamlValue& value, RobotModel* model) {
  const YamlMap rotors = value.AsMap();
  for (const YamlMap::Entry& entry : rotors.entries()) {
    CheckName(entry);
    model->rotors.push_back(LoadRotor(entry, *model));
  }
}

RotorDriveSpec LoadRotorDrive(const YamlMap& map, const Scenario& scenario) {
  const std::size_t index = FindModel(*map.Find("model"), scenario);
  const RobotModel& model = scenario.world->models[index];
  const int first = FirstOf(index, scenario, &RobotModel::rotors);
  RotorDriveSpec spec;
  spec.model = model.name;
  const YamlValue* drive = map.Find("drive");
  spec.is_normalised = drive != nullptr && LoadIsNormalised(*drive);
  for (const YamlValue& value : map.Find("rotors")->AsList("[front, rear]")) {
    const int rotor = Find(value, model.rotors, "rotor", model.name);
    const double most_radps = model.rotors[static_cast<std::size_t>(rotor)].most_radps;
    if (std::ranges::find(spec.rotors, first + rotor) != spec.rotors.end()) {
      value.Fail("names the rotor '" + value.AsText() + "' a second time; remove it");
    }
    if (spec.is_normalised && most_radps == kNoLimit) {
      drive->Fail("is normalised, but the rotor '" + value.AsText() +
                  "' has no limit to be a share of; give it a limit");
    }
    spec.rotors.push_back(first + rotor);
    spec.names.push_back(value.AsText());
    spec.most_radps.push_back(most_radps);
  }
  return spec;
}

}  // namespace tcs
