// The visible things of a scenario's world, as scene.json has them (docs/RESULTS.md): shapes, what
// they are fixed to, and the sensors that have rays. bodies.csv says where things are at a time.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"

namespace tcs {

// JSON; empty for a scenario without a world.
[[nodiscard]] std::string SceneText(const Scenario& scenario);

}  // namespace tcs
