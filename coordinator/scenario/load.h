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

// What the command line sets in the file's stead. The next four, which win over `set`, must be
// valid (durations above 0).
struct ScenarioOverrides {
  std::vector<std::string> overlays;  // files, see overlay.h; checked like the scenario's
  std::vector<std::string> set;       // "KEY=VALUE", see set_option.h, after them; the same
  std::optional<VirtualDuration> duration;
  std::optional<VirtualDuration> drift, patience;
  std::optional<std::uint64_t> seed;  // also what ${seed} stands for
  // Absolute: what ${result_dir} stands for, where clients may have folders.
  std::string result_directory;
  std::uint32_t run = 0;  // what ${run} and ${loopback} stand for (substitute.h)
};

// Loads and checks the scenario in the file `path`: whatever it returns can be run, unless the
// files it names change or the ports it names are taken. The first mistake is the error, one
// sentence beginning "PATH:LINE: " (a file that cannot be read has no line: "PATH: "), or "--set
// KEY=VALUE: " where the value does not come from a file. Reads the environment (PATH, ${NAME});
// not thread-safe against threads that change it.
[[nodiscard]] LoadResult<Scenario> LoadScenario(const std::string& path,
                                                const ScenarioOverrides& overrides = {});

// The same, but returns all mistakes that can be told apart, in the order of the file; not empty.
[[nodiscard]] std::variant<Scenario, std::vector<LoadError>> CheckScenario(
    const std::string& path, const ScenarioOverrides& overrides = {});

// What the overlay `path` says, as --set would: a "KEY=VALUE" for each value.
[[nodiscard]] LoadResult<std::vector<std::string>> LoadOverlay(const std::string& path);

}  // namespace tcs
