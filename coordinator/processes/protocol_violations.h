// A process that has written what cannot be into the memory that it shares with the coordinator
// (slot_check.h) is ended; the run goes on.
//
// For the coordinator's thread only. Makes system calls, and waits for the process's end for at
// most a second of real time.
#pragma once

#include "coordinator/host/host_cpu.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class ProtocolViolations {
 public:
  ProtocolViolations(RunState& run, Waker& waker, HostCpu& cpu)
      : run_(run), waker_(waker), cpu_(cpu) {}

  // Kills the process. `what` is wrong, and goes on after "has written what cannot be (". The
  // process's threads wait for nothing any more but their end; the running one's turn ends as ever.
  // Once is enough.
  void EndProcess(Process& process, const char* what);
  // The thread waits for nothing any more.
  void AwaitExit(Task& task);

 private:
  RunState& run_;
  Waker& waker_;
  HostCpu& cpu_;
};

}  // namespace tcs
