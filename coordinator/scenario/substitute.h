// ${…} in the commands, environments and folders of a scenario's clients.
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

struct Variables {
  std::uint64_t seed = 1;          // ${seed}
  std::string scenario_directory;  // ${scenario_dir}: the file's folder, absolute
  std::string result_directory;    // ${result_dir}: where the run's results go, absolute
};

// The text of `value` with ${seed}, ${scenario_dir} and ${result_dir} replaced by what they are in
// this run, and ${NAME} by tcsim's environment variable NAME; $${ stands for ${ itself. Other
// dollar signs stay. Throws ScenarioMistake.
std::string Substitute(const YamlValue& value, const Variables& variables);

}  // namespace tcs
