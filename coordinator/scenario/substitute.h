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
  // ${run} and ${loopback}: texts of one length that are the run's own (see below).
  std::uint32_t run = 0;
};

// The number of a run in eight digits, which begin with a letter or a digit: a part of a name that
// no other run has. And an address of this computer's loopback network that hardly another run has,
// one of 3.8 million.
std::string RunName(std::uint32_t run);
std::string LoopbackAddressOf(std::uint32_t run);

// The text of `value` with ${seed}, ${scenario_dir}, ${result_dir}, ${run} and ${loopback} replaced
// by what they are in this run, and ${NAME} by tcsim's environment variable NAME; $${ stands for ${
// itself. Other dollar signs stay. Throws ScenarioMistake.
std::string Substitute(const YamlValue& value, const Variables& variables);

}  // namespace tcs
