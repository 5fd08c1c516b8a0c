// The joints that a channel is about. Internal to LoadScenario: mistakes are thrown as
// ScenarioMistake.
#pragma once

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// Whether the channel with the keys of `map` is about joints: it names a model, and no body by
// `body_key`.
bool IsAboutJoints(const YamlMap& map, const char* body_key);

// `model` and `joints`: all that have one coordinate, where none are named.
JointGroup LoadJointGroup(const YamlMap& map, const Scenario& scenario);

// The same of joints that can be driven; `drive`, `stiffness` and `damping`.
JointDriveSpec LoadJointDrive(const YamlMap& map, const Scenario& scenario);

}  // namespace tcs
