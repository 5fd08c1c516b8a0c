// The way from a YAML file (docs/SCENARIO.md) to a Scenario.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/scenario/scenario.h"
#include "shm/virtual_time.h"

namespace tcs {

// The values that the command line sets in the file's stead. The next four after `set`, which win
// over it, must be valid (durations above 0).
struct ScenarioOverrides {
  std::vector<std::string> overlays;  // files, see overlay.h; checked like the scenario's
  std::vector<std::string> set;       // "KEY=VALUE", see set_option.h, after the overlays; the same
  std::optional<VirtualDuration> duration;
  std::optional<VirtualDuration> drift, patience;
  std::optional<std::uint64_t> seed;  // also what ${seed} stands for
  // Absolute: the value of ${result_dir}, where clients may have folders.
  std::string result_directory;
  std::uint32_t run = 0;  // gives the values of ${run} and ${loopback} (substitute.h)
};

// Loads and checks the scenario in the file `path`: a scenario that is returned can be run, unless
// the files that it names change or the ports that it names are taken. The first mistake is the
// error, one sentence beginning "PATH:LINE: " (a file that cannot be read has no line: "PATH: "),
// or "--set KEY=VALUE: " where the value does not come from a file. Reads the environment (PATH,
// ${NAME}); not thread-safe against threads that change it.
[[nodiscard]] LoadResult<Scenario> LoadScenario(const std::string& path,
                                                const ScenarioOverrides& overrides = {});

// Does what LoadScenario does, but returns all mistakes that can be told apart, in the order of the
// file; not empty.
[[nodiscard]] std::variant<Scenario, std::vector<LoadError>> CheckScenario(
    const std::string& path, const ScenarioOverrides& overrides = {});

// The values in the overlay `path`, as --set would give them: a "KEY=VALUE" for each value.
[[nodiscard]] LoadResult<std::vector<std::string>> LoadOverlay(const std::string& path);

}  // namespace tcs
