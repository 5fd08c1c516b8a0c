// What sensors tell, what is wrong with it, and how commands act. Internal to
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

// `latency`, `axes`, `lag` and `limits`: what becomes of a command before it acts. Axes are the
// world's or those of `own`, a "body" or a "link".
void LoadCommandEffect(const YamlMap& map, const std::string& own, CommandChannelSpec* command);

}  // namespace tcs
