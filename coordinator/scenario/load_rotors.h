// Rotors of models: their properties, and the channels that command them. Internal to LoadScenario:
// mistakes are thrown as ScenarioMistake.
#pragma once

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// `rotors` of a robot, whose links and joints are there.
void LoadRotors(const YamlValue& value, RobotModel* model);

// `model`, `rotors` and `drive` of a channel of commands.
RotorDriveSpec LoadRotorDrive(const YamlMap& map, const Scenario& scenario);

}  // namespace tcs
