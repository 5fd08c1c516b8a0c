// The joints that a channel is about. Internal to LoadScenario: mistakes are thrown as
// ScenarioMistake.
#pragma once

#include <string>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// Whether the channel with the keys of `map` is about a model: the channel names a model, and no
// body by `body_key`.
bool IsOfModel(const YamlMap& map, const char* body_key);

// `model` and `joints`: all joints that have one coordinate, where no joints are named.
JointGroup LoadJointGroup(const YamlMap& map, const Scenario& scenario);

// The keys that a channel which drives joints can have; for wheels these are other keys.
std::vector<std::string> JointDriveKeys(const YamlMap& map);

// `model` and `joints` for joints that can be driven; `drive`, `stiffness`, `damping` and `lag`.
// With `drive: differential` the joints are wheels, and the keys say of which robot.
JointDriveSpec LoadJointDrive(const YamlMap& map, const Scenario& scenario);
// Gives the joints the lag of the channel that drives them. All channels of a joint have the same
// lag.
void SetDriveLag(const YamlMap& map, const JointDriveSpec& spec, Scenario* scenario);

// The index of the model that `value` names.
std::size_t FindModel(const YamlValue& value, const Scenario& scenario);

// `model`, and `left` and `right`: wheels, the left ones first.
struct WheelGroup {
  JointGroup group;
  std::size_t left = 0;
  double most_radps = 0;  // the speed that no wheel is to exceed
};
WheelGroup LoadWheels(const YamlMap& map, const Scenario& scenario);

// `separation` and `radius`.
WheelBase LoadWheelBase(const YamlMap& map);

// The model that `value` names, and the number of its first link.
struct ModelPlace {
  const RobotModel* model;
  int first_link;
};
ModelPlace FindModelPlace(const YamlValue& value, const Scenario& scenario);

}  // namespace tcs
