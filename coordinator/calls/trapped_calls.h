// System calls of clients that the kernel hands over.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/calls/futex_calls.h"
#include "coordinator/calls/guarded_calls.h"
#include "coordinator/calls/local_sockets.h"
#include "coordinator/calls/spawns.h"
#include "coordinator/calls/syscalls.h"
#include "coordinator/host/executor.h"
#include "coordinator/port/traps.h"
#include "coordinator/processes/thread_exit.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class TrappedCalls {
 public:
  TrappedCalls(RunState& run, Waker& waker, FutexCalls& futexes, Syscalls& syscalls,
               const GuardedCalls& guard, ThreadExit& thread_exit, Executor& executor,
               LocalSockets& local_sockets, Spawns& spawns)
      : run_(run),
        waker_(waker),
        futexes_(futexes),
        syscalls_(syscalls),
        guard_(guard),
        thread_exit_(thread_exit),
        executor_(executor),
        local_sockets_(local_sockets),
        spawns_(spawns) {}

  // Handles the call of a thread that has stopped in it. True: there may be more events by now that
  // belong to this moment.
  bool Handle(Task& task, const TrappedCall& call);
  // Handles the call of a thread that tcs does not know, or that has not registered yet.
  void HandleUnregistered(const TrappedCall& call, EventTime when);
  // The last call of a thread.
  void Exit(Task& task, const TrappedCall& call);
  // At the end of a run the kernel carries out all calls, including the calls that wait.
  void ReleaseAll();

 private:
  RunState& run_;
  Waker& waker_;
  FutexCalls& futexes_;
  Syscalls& syscalls_;
  const GuardedCalls& guard_;
  ThreadExit& thread_exit_;
  Executor& executor_;
  LocalSockets& local_sockets_;
  Spawns& spawns_;
};

}  // namespace tcs
