// Trapped calls other than futex: made raw, or by the C library from inside, where no interposed
// symbol sees them. The thread waits here for what such a call waits for; then the kernel carries
// the call out, and does not have to wait.
//
// For the coordinator's thread only.
#pragma once

#include <functional>
#include <utility>

#include "coordinator/calls/computer_files.h"
#include "coordinator/calls/futex_words.h"
#include "coordinator/calls/local_sockets.h"
#include "coordinator/calls/spawns.h"
#include "coordinator/calls/syscall_child_waits.h"
#include "coordinator/calls/syscall_ipc.h"
#include "coordinator/calls/syscall_limits.h"
#include "coordinator/calls/syscall_polls.h"
#include "coordinator/calls/syscall_scheduling.h"
#include "coordinator/calls/syscall_timers.h"
#include "coordinator/calls/syscall_times.h"
#include "coordinator/calls/syscall_transfers.h"
#include "coordinator/calls/syscall_usage.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class Syscalls {
 public:
  struct Parts {
    SyscallTimes& times;
    SyscallUsage& usage;
    SyscallTimers& timers;
    SyscallPolls& polls;
    SyscallTransfers& transfers;
    SyscallChildWaits& children;
    SyscallScheduling& scheduling;
    SyscallIpc& ipc;
    FutexWords& words;
    LocalSockets& local_sockets;
    ComputerFiles& computer_files;
    SyscallLimits& limits;
  };

  // `yield` lets equal threads have their turn (true: as Handle); `exit` ends the thread.
  Syscalls(RunState& run, Waker& waker, Parts parts, std::function<bool(Task&)> yield,
           std::function<void(Task&, const TrappedCall&)> exit)
      : run_(run), waker_(waker), parts_(parts), yield_(std::move(yield)), exit_(std::move(exit)) {}

  // task.trap_result is what the call returns, unless the thread waits or the kernel carries it out
  // (task.trap_continues). True: there may be more events by now that belong to this moment.
  bool Handle(Task& task, const TrappedCall& call);

 private:
  void Signal(Task& task);
  void Suspend(Task& task);
  void Lock(Task& task);

  RunState& run_;
  Waker& waker_;
  Parts parts_;
  std::function<bool(Task&)> yield_;
  std::function<void(Task&, const TrappedCall&)> exit_;
};

}  // namespace tcs
