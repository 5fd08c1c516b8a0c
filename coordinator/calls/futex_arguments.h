// The errors that the kernel finds in a futex call before it looks at the word, in the kernel's
// order.
#pragma once

#include <cstdint>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"

namespace tcs {

// 0, or the call's error. `command` is one of FUTEX_*, without its flags.
std::int64_t WrongFutexCall(const Task& task, const TrappedCall& call, int command);

}  // namespace tcs
