// Sensors of robots that cast rays, and where any sensor sits. Internal to LoadScenario: mistakes
// are thrown as ScenarioMistake.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// `on`, `at` and `frame`.
Mount LoadMount(const YamlMap& map, const Scenario& scenario);

// `range`: loaded over what `reach` has already.
ReachSpec LoadReach(const YamlMap& map, ReachSpec reach);

// The sensors that cast rays.
InstrumentSpec LoadLidar(const YamlMap& map, const Scenario& scenario, VirtualDuration period);
InstrumentSpec LoadLidar3d(const YamlMap& map, const Scenario& scenario, VirtualDuration period);
InstrumentSpec LoadRange(const YamlMap& map, const Scenario& scenario, VirtualDuration period);
InstrumentSpec LoadDepthCamera(const YamlMap& map, const Scenario& scenario,
                               VirtualDuration period);

}  // namespace tcs
