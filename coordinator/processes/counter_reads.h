// The warning about programs that read the processor's cycle counter, where the shim could not lead
// the read to the virtual one.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/tasks/run_state.h"
#include "shm/layout.h"

namespace tcs {

// Where reads of the counter are that are the processor's still.
struct CounterReads {
  std::int64_t places = 0;
  std::uint64_t first = 0;  // an address in the program
  shm::WhereReads where = shm::WhereReads::kInFile;
};

// Warns once for a client.
void WarnOfCounterReads(RunState& run, const Process& process, const CounterReads& reads);

}  // namespace tcs
