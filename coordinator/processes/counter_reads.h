// What is said of programs that read the processor's cycle counter, where the shim could not lead
// the read to the virtual one.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/tasks/run_state.h"

namespace tcs {

// Warns once for a client. `first`: an address in the program, the first of so many places;
// `mend`: what its user can do.
void WarnOfCounterReads(RunState& run, const Process& process, std::int64_t places,
                        std::uint64_t first, const char* mend);

}  // namespace tcs
