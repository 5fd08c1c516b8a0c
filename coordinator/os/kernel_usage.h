// The kernel's counts for a process or a thread besides its time, as getrusage tells them of the
// caller itself.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace tcs {

struct KernelUsage {
  std::int64_t user_ticks = 0, system_ticks = 0;  // in whatever unit: only their ratio counts
  std::int64_t minor_faults = 0, major_faults = 0;
  std::int64_t peak_kib = 0;  // resident
  std::int64_t waits = 0, preemptions = 0;
};

// All zero where the process or thread has ended. The usage of a process includes all its threads
// that live.
KernelUsage KernelUsageOfProcess(pid_t pid);
KernelUsage KernelUsageOfThread(pid_t pid, pid_t tid);
// The usage of the process's children that it has waited for.
KernelUsage KernelUsageOfChildren(pid_t pid);

}  // namespace tcs
