// Raw calls by which threads ask for the processor time that was charged, and for the computer's
// uptime. Results are the kernel's: negative for an errno.
//
// For the coordinator's thread only.
#pragma once

#include <sys/resource.h>

#include <cstdint>

#include "coordinator/os/kernel_usage.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class SyscallUsage {
 public:
  explicit SyscallUsage(RunState& run) : run_(run) {}

  // clock_gettime of a clock of processor time, the caller's or another's.
  std::int64_t ReadClock(Task& task, const TrappedCall& call) const;
  // getrusage. The charge is divided into user and system time as the kernel divides it; set costs
  // are user time.
  std::int64_t GetUsage(const Task& task, const TrappedCall& call) const;
  std::int64_t Times(const Task& task, const TrappedCall& call) const;
  // sysinfo: the host's, with the robot's uptime.
  std::int64_t SystemInfo(const Task& task, const TrappedCall& call) const;

 private:
  void Fill(const KernelUsage& counted, std::int64_t charged_ns, rusage& usage) const;
  std::int64_t UptimeNs(const Task& task) const;

  RunState& run_;
};

}  // namespace tcs
