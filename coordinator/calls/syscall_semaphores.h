// The effect that System V semaphores would have on a call that a thread makes raw.
//
// Asks the kernel, and reads the client's memory. For the coordinator's thread only.
#pragma once

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"

namespace tcs {

// Whether semop or semtimedop would have to wait, as the semaphores are now. False, too, where
// something is wrong with the call: the kernel says best what.
bool WouldWaitForSemaphores(const Task& task, const TrappedCall& call);

// False once they have been removed, or if the coordinator may not look at them.
bool AreSemaphores(int id);

}  // namespace tcs
