// Values that several sections of a scenario have. Internal to LoadScenario: mistakes are thrown as
// ScenarioMistake.
#pragma once

#include <array>

#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// A quaternion x, y, z, w of length 1, within 1e-3; the result is normalised.
std::array<double, 4> LoadOrientation(const YamlValue& value);

}  // namespace tcs
