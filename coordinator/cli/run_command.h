// `tcsim run`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/tasks/coordinator.h"

namespace tcs {

struct RunArguments {
  std::string scenario, duration, stop_at, drift, out = "out";
  std::optional<std::uint64_t> seed;
  std::vector<std::string> overlays;  // files
  std::vector<std::string> set;       // KEY=VALUE
  bool check = false;                 // load the scenario, and no more
  int progress_fd = -1;               // a file that gets the virtual time; -1: none
};

// The exit status. `options` brings accounting, synchronisation and the shim.
int RunCommand(const RunArguments& arguments, RunOptions options);

}  // namespace tcs
