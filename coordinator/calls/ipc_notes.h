// What threads have done to System V objects, where all processes can read it (shm/ipc_times.h).
#pragma once

#include "coordinator/tasks/task.h"
#include "shm/layout.h"

namespace tcs {

// Publishes what the thread, which has registered and is stopped, has noted in its slot. Null; or
// what of it cannot be, as SlotCheck has it: where the date was set, any time can. For the
// coordinator's thread only; makes no system call.
const char* TakeIpcNotes(Task& task, shm::RunMemory& memory, bool date_was_set);

}  // namespace tcs
