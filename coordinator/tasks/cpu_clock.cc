#include "coordinator/tasks/cpu_clock.h"

#include "coordinator/port/clocks.h"

namespace tcs {

std::int64_t HostClockOf(Task& task) {
  if (task.process->threads == 1) return ProcessCpuClockNs(task.tid);
  if (!task.cpu_clock_fd) task.cpu_clock_fd.Reset(OpenThreadCpuClock(task.tid));
  return ReadThreadCpuClock(task.cpu_clock_fd.get());
}

}  // namespace tcs
