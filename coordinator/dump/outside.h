// The state of a run whose coordinator does not answer, from outside: the kernel's facts on the
// run's processes and their threads, and the contents of the memory that each process shares with
// the coordinator.
#pragma once

#include <nlohmann/json.hpp>

#include "coordinator/dump/find_run.h"

namespace tcs {

// {"processes": [{"pid", "name", "threads": [{"tid", "kernel": …, "slot": …}]}]}, of all
// processes that descend from the coordinator. "slot" is of threads that have registered: what the
// thread last asked the coordinator for ("asked"), when ("at_ns") and until when ("until_ns"), what
// its clock has shown ("shown_ns"), how far it may run ("horizon_ns"), and its gate.
[[nodiscard]] nlohmann::ordered_json SeenFromOutside(const FoundRun& run);

}  // namespace tcs
