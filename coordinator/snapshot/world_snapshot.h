// A snapshot of a run's world: how its bodies, models and joints were at one moment, as a piece of
// a scenario that `tcsim run --overlay` takes. A run from there begins with the world as it was;
// programs begin anew, and so does what they had set going: commands, lags, speeds of rotors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/errors/load_error.h"

namespace tcs::snapshot {

// As YAML; what is wrong is one sentence. None: the last moment that the run has written.
[[nodiscard]] LoadResult<std::string> WorldAt(const std::string& folder,
                                              std::optional<std::int64_t> at_ns);

}  // namespace tcs::snapshot
