// The CPU clocks of threads, as the host's kernel keeps them: host time, of which charges are made.
//
// For the coordinator's thread only. Each reading is a system call.
#pragma once

#include <cstdint>

#include "coordinator/host/meter.h"
#include "coordinator/tasks/task.h"

namespace tcs {

// The time on the thread's own CPU clock; -1 if the clock cannot be read any more. The descriptor
// that the clock takes is kept in the task.
std::int64_t HostClockOf(Task& task);

inline Meter::CpuClock CpuClockOf(Task& task) {
  return [&task] { return HostClockOf(task); };
}

}  // namespace tcs
