// Threads that wait for each other's locks, for ever, as far as locks say who has them (locks.h).
//
// For the coordinator's thread only. Reads the memory of programs.
#pragma once

#include <string>
#include <vector>

#include "coordinator/queues/futex_table.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

// A sentence for each ring of threads.
std::vector<std::string> DeadlocksIn(const RunState& run, const FutexTable& futexes);

}  // namespace tcs
