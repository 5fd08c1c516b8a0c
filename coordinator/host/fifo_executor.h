// By real-time priorities, as the paper does it: all threads of a run share one processor under
// SCHED_FIFO, and a thread that may run has the level above the others' (port/levels.h).
#pragma once

#include "coordinator/host/executor.h"
#include "coordinator/port/levels.h"

namespace tcs {

class FifoExecutor final : public Executor {
 public:
  void LetRun(pid_t tid) override { SetLevel(tid, Level::kActive); }
  void Hold(pid_t tid) override { SetLevel(tid, Level::kWaiting); }
  // The thread runs above the coordinator, so that no thread runs meanwhile that is not to.
  void LetKernelFinish(pid_t tid) override {
    SetLevel(tid, Level::kKernelOnly);
    SetLevel(tid, Level::kWaiting);
  }
  void LetGo(pid_t tid) override { LeaveRealTime(tid); }
};

}  // namespace tcs
