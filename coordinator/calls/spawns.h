// Threads and processes whose makers have said that they made them: they are known from then on,
// and held until their first dispatch.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include "coordinator/calls/scheduling_calls.h"
#include "coordinator/host/executor.h"
#include "coordinator/processes/births.h"
#include "coordinator/processes/unmanaged_threads.h"
#include "coordinator/tasks/run_state.h"
#include "shm/layout.h"

namespace tcs {

class Spawns {
 public:
  Spawns(RunState& run, Executor& executor, Births& births, SchedulingCalls& scheduling,
         const UnmanagedThreads& unmanaged)
      : run_(run),
        executor_(executor),
        births_(births),
        scheduling_(scheduling),
        unmanaged_(unmanaged) {}

  // kSpawned.
  void Handle(Task& maker, const shm::Notification& note);

 private:
  void OfThread(Task& creator, const shm::Notification& note);
  void OfProcess(Task& parent, pid_t pid);

  RunState& run_;
  Executor& executor_;
  Births& births_;
  SchedulingCalls& scheduling_;
  const UnmanagedThreads& unmanaged_;
};

}  // namespace tcs
