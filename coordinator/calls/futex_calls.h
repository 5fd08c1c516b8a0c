// The futex calls that the kernel hands over: all waiting of a process's threads for each other
// ends there.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/futex_words.h"
#include "coordinator/calls/lock_futexes.h"
#include "coordinator/os/trap.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class FutexCalls {
 public:
  FutexCalls(RunState& run, Waker& waker, FutexWords& words, LockFutexes& locks)
      : run_(run), waker_(waker), words_(words), locks_(locks) {}

  // Carries the call out, or has the thread wait; task.trap_result is what it returns.
  void Handle(Task& task, const TrappedCall& call);
  // FUTEX_WAKE and FUTEX_WAKE_BITSET, whoever of the process calls: the threads woken; none for
  // other commands.
  std::int64_t CarryOutWake(const Process& process, const TrappedCall& call, Moment moment);

 private:
  bool HoldsToWake(Task& task, const TrappedCall& call, int command);
  std::int64_t Requeue(const Task& task, const TrappedCall& call, int command);
  std::int64_t WakeOp(const Task& task, const TrappedCall& call);

  RunState& run_;
  Waker& waker_;
  FutexWords& words_;
  LockFutexes& locks_;
};

}  // namespace tcs
