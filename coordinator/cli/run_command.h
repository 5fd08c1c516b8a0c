// `tcsim run`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/core/coordinator.h"

namespace tcs {

struct RunArguments {
  std::string scenario, duration, drift, out = "out";
  std::optional<std::uint64_t> seed;
};

// The exit status. `options` brings accounting, synchronisation and the shim.
int RunCommand(const RunArguments& arguments, RunOptions options);

}  // namespace tcs
