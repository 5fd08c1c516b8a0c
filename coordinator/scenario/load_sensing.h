// The fields that sensors tell, their errors, and how commands act. Internal to LoadScenario:
// mistakes are thrown as ScenarioMistake.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

std::vector<SensorField> LoadSensorFields(const YamlValue& value);

// The seed of the sensor of that name, `dropout` and `jitter`.
SensorErrors LoadSensorErrors(const YamlMap& map, const std::string& name, std::uint64_t seed);

// `noise` and `bias`, of bodies, of joints, and of anything else that has named fields.
void LoadBodyErrors(const YamlMap& map, SensorErrors* errors);
void LoadJointErrors(const YamlMap& map, SensorErrors* errors);
struct NamedError {
  std::string name;
  FieldError* error;
  bool is_number;  // not a vector
};
void LoadFieldErrors(const YamlMap& map, std::span<const NamedError> fields);

// `latency`, `axes`, `lag` and `limits`: the keys say what becomes of a command before it acts.
// Axes are the world's, or the axes of `own`, a "body" or a "link".
void LoadCommandEffect(const YamlMap& map, const std::string& own, CommandChannelSpec* command);

}  // namespace tcs
