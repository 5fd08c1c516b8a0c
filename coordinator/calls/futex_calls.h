// The futex calls that the kernel hands over: in the end, a process's threads wait for each other
// by them only.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "coordinator/calls/futex_words.h"
#include "coordinator/calls/lock_futexes.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class FutexCalls {
 public:
  // `stands_still` makes sure that, from now on, no thread runs that could change a word of the
  // process (null: of any process) while FutexCalls changes the word.
  FutexCalls(RunState& run, Waker& waker, FutexWords& words, LockFutexes& locks,
             std::function<void(Process*)> stands_still)
      : run_(run),
        waker_(waker),
        words_(words),
        locks_(locks),
        stands_still_(std::move(stands_still)) {}

  // Carries the call out, or has the thread wait; task.trap_result is what it returns.
  void Handle(Task& task, const TrappedCall& call);
  // FUTEX_WAKE and FUTEX_WAKE_BITSET, from any thread of the process: the number of threads woken;
  // 0 for other commands.
  std::int64_t CarryOutWake(const Process& process, const TrappedCall& call, EventTime when);

 private:
  bool HoldsToWake(Task& task, const TrappedCall& call, int command);
  std::int64_t Requeue(const Task& task, const TrappedCall& call, int command);
  std::int64_t WakeOp(const Task& task, const TrappedCall& call);

  RunState& run_;
  Waker& waker_;
  FutexWords& words_;
  LockFutexes& locks_;
  const std::function<void(Process*)> stands_still_;
};

}  // namespace tcs
