// Priority-inheritance futexes (FUTEX_LOCK_PI and its kin): the word holds the owner's thread id, a
// thread that waits lends the owner its priority, and an unlock hands the lock on. Also conditions
// whose waker hands the waiting threads on to such a lock (FUTEX_WAIT_REQUEUE_PI,
// FUTEX_CMP_REQUEUE_PI).
//
// Results are the kernel's: negative for an errno. For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/futex_words.h"
#include "coordinator/calls/priority_inheritance.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class LockFutexes {
 public:
  LockFutexes(RunState& run, Waker& waker, FutexWords& words, PriorityInheritance& inheritance)
      : run_(run), waker_(waker), words_(words), inheritance_(inheritance) {}

  std::int64_t Lock(Task& task, const TrappedCall& call, int command);
  std::int64_t Unlock(Task& task, const TrappedCall& call);

  std::int64_t WaitAtCondition(Task& task, const TrappedCall& call);
  std::int64_t RequeueFromCondition(Task& task, const TrappedCall& call);

  // The threads that wait for the thread to end, or for a lock that it held, go on: the kernel's
  // own wake does not reach them.
  void WakeThoseWaitingFor(Task& ended, EventTime when);

 private:
  bool HandOn(const FutexKey& key, std::uint32_t flags, EventTime when);
  void Requeue(Task& waiter, const FutexKey& lock, Task& owner);

  RunState& run_;
  Waker& waker_;
  FutexWords& words_;
  PriorityInheritance& inheritance_;
};

}  // namespace tcs
