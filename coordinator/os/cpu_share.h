// The host CPU of a run without real-time priorities. All threads of the run take turns there, as
// ordinary threads (host/gate_executor.h), so that several such runs may be on one CPU: no such run
// claims it, waits for it, or keeps others from it.
//
// Beside a run with real-time priorities an ordinary thread has next to nothing of a CPU. So a run
// without such priorities goes where no run with them is, and leaves a CPU that such a run has
// claimed meanwhile. Where runs with real-time priorities have all CPUs, the run stays, and has
// what the kernel leaves to ordinary threads (50 ms of each second).
//
// For the coordinator's thread only; nothing is left behind (cpu_register.h).
#pragma once

#include <vector>

#include "coordinator/os/cpu_register.h"

namespace tcs {

class CpuShare {
 public:
  // Chooses one of the CPUs that the calling thread may use. The thread is not bound there yet.
  CpuShare();

  int cpu() const { return cpu_; }
  // This process, and all that descend from it, leave the CPU if it was claimed and another CPU was
  // not. True if they have left.
  bool LeaveIfClaimed();

 private:
  int Choose() const;

  const std::vector<int> allowed_;
  CpuRegister others_;
  int cpu_ = -1;
};

}  // namespace tcs
