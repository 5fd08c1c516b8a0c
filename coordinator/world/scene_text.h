// What there is to see in a scenario's world, as scene.json has it (docs/RESULTS.md): shapes, what
// they are fixed to, and the sensors that have rays. Where things are at a time is in bodies.csv.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"

namespace tcs {

// JSON; empty for a scenario without a world.
[[nodiscard]] std::string SceneText(const Scenario& scenario);

}  // namespace tcs
