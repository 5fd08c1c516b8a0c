// ${…} in the commands and environments of a scenario's clients.
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// The text of `value` with ${seed} replaced by the run's seed and ${NAME} by tcsim's environment
// variable NAME; $${ stands for ${ itself. Other dollar signs stay. Throws ScenarioMistake.
std::string Substitute(const YamlValue& value, std::uint64_t seed);

}  // namespace tcs
