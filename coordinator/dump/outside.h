// The state of a run whose coordinator does not answer, from outside: what the kernel says of its
// processes and their threads, and what stands in the memory that each shares with the coordinator.
#pragma once

#include <nlohmann/json.hpp>

#include "coordinator/dump/find_run.h"

namespace tcs {

// {"processes": [{"pid", "name", "threads": [{"tid", "kernel": …, "slot": …}]}]}, all that descend
// from the coordinator. "slot" is of threads that have registered: what the thread last asked the
// coordinator for ("asked"), when ("at_ns") and until when ("until_ns"), what its clock has shown
// ("shown_ns"), how far it may run ("horizon_ns"), and its gate.
[[nodiscard]] nlohmann::ordered_json SeenFromOutside(const FoundRun& run);

}  // namespace tcs
