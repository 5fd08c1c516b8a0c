// The air of a scenario: `dynamics.wind` and the bodies' `drag`. Internal to LoadScenario: mistakes
// are thrown as ScenarioMistake.
#pragma once

#include <cstdint>

#include "coordinator/scenario/yaml_reader.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

// `seed` is the scenario's.
WindSpec LoadWind(const YamlValue& value, std::uint64_t seed);
DragSpec LoadDrag(const YamlValue& value);

}  // namespace tcs
