// The joints that a channel is about. Internal to LoadScenario: mistakes are thrown as
// ScenarioMistake.
#pragma once

#include <string>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// Whether the channel with the keys of `map` is about joints: it names a model, and no body by
// `body_key`.
bool IsAboutJoints(const YamlMap& map, const char* body_key);

// `model` and `joints`: all that have one coordinate, where none are named.
JointGroup LoadJointGroup(const YamlMap& map, const Scenario& scenario);

// Of a channel that drives joints: the keys that it can have, which are others where they are
// wheels.
std::vector<std::string> JointDriveKeys(const YamlMap& map);

// The same of joints that can be driven; `drive`, `stiffness` and `damping`. With
// `drive: differential` the joints are wheels, and the keys say of which robot.
JointDriveSpec LoadJointDrive(const YamlMap& map, const Scenario& scenario);

// `separation` and `radius`.
WheelBase LoadWheelBase(const YamlMap& map);

}  // namespace tcs
