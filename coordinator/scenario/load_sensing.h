// What sensors tell, what is wrong with it, and what commands are held to. Internal to
// LoadScenario: mistakes are thrown as ScenarioMistake.
#pragma once

#include <string>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

std::vector<SensorField> LoadSensorFields(const YamlValue& value);

// `noise`, `bias`, `dropout` and `jitter` of a sensor of that name.
SensorErrors LoadSensorErrors(const YamlMap& map, const std::string& name, std::uint64_t seed);

// `limits`.
void LoadCommandLimits(const YamlValue& value, CommandChannelSpec* command);

}  // namespace tcs
