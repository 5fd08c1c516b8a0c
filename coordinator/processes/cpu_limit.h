// How much processor time a process may use (RLIMIT_CPU): the time that the process was charged
// counts, so the kernel does not hear of limits that are set within a run. Timers on the process's
// processor time send the signals.
//
// For the coordinator's thread only.
#pragma once

#include <sys/resource.h>

#include "coordinator/tasks/task.h"

namespace tcs {

// The limit in whole seconds, as getrlimit tells of it. The soft limit, which is not exceeded yet,
// grows by a second with each signal.
rlimit CpuLimitOf(const Process& process);
// The limit must not be above its own maximum.
void SetCpuLimit(Process& process, const rlimit& limit);
// A child has its parent's limit, and begins to count anew.
void InheritCpuLimit(const Process& parent, Process& child);

}  // namespace tcs
