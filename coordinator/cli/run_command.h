// `tcsim run`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/cli/gdb_session.h"
#include "coordinator/tasks/coordinator.h"

namespace tcs {

struct RunArguments {
  std::string scenario = "scenario.yaml", duration, stop_at, drift, patience, out = "out";
  std::string debugged;  // ROBOT/CLIENT, for gdb; empty: none
  std::optional<std::uint64_t> seed;
  std::vector<std::string> overlays;  // files
  std::vector<std::string> set;       // KEY=VALUE
  bool check = false;                 // load the scenario, and no more
  double pace = 0;                    // 0: as fast as it can
  bool pauses = false;                // the run starts standing
  bool strict = false;                // each warning is an error
  std::string junit;                  // a file for the judgement; empty: none
  int progress_fd = -1;               // a file that gets the virtual time; -1: none
};

// The exit status. `options` brings accounting, synchronisation and the shim; `gdb` is for the
// client that is debugged, if one is.
int RunCommand(const RunArguments& arguments, RunOptions options, const GdbSession& gdb = {});

}  // namespace tcs
