// Notes of what threads have done to System V objects, where all processes can read them
// (shm/ipc_times.h).
#pragma once

#include "coordinator/tasks/task.h"
#include "shm/layout.h"

namespace tcs {

// Publishes the notes in the slot of the thread, which has registered and is stopped. Null, or what
// in the notes is impossible, as in SlotCheck; where the date was set, any time is possible. For
// the coordinator's thread only; makes no system call.
const char* TakeIpcNotes(Task& task, shm::RunMemory& memory, bool date_was_set);

}  // namespace tcs
