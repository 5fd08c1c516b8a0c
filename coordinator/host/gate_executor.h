// By the threads' own gates, for users who may not have real-time priorities. A thread that waits
// at its gate runs when the gate is opened. A thread that was stopped elsewhere runs on until its
// next call, which begins at its gate (RunHeader::is_unprivileged); its clock stands still
// meanwhile. A thread that computes is sent to its gate by a signal (port/thread_signals.h).
#pragma once

#include "coordinator/host/executor.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/waits.h"

namespace tcs {

class GateExecutor final : public Executor {
 public:
  void LetRun(pid_t) override {}
  void Hold(pid_t) override {}
  // Other threads may have the processor first. A thread that computes instead of stopping is not
  // waited for without end.
  void LetKernelFinish(pid_t tid) override {
    for (int turns = 0; turns < kMostTurns; ++turns) {
      Pause(kTurn);
      if (ThreadState(tid) != 'R') return;
    }
  }

  bool StandsStill() const override { return false; }

 private:
  static constexpr HostDuration kTurn = HostDuration::Microseconds(100);
  static constexpr int kMostTurns = 1000;
};

}  // namespace tcs
