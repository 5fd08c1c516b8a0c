// The work that is due after a call that was let through to the kernel: other threads may go on
// because of the call, at the time of the call. So the calling thread runs just long enough for the
// kernel to carry the call out, and is then stopped.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/calls/kernel_object_waits.h"
#include "coordinator/calls/shared_events.h"
#include "coordinator/calls/signal_calls.h"
#include "coordinator/calls/signal_wakes.h"
#include "coordinator/calls/spawns.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class AfterCalls {
 public:
  AfterCalls(RunState& run, KernelObjectWaits& objects, SharedEvents& shared_events,
             SignalCalls& signals, SignalWakes& signal_wakes, Spawns& spawns)
      : run_(run),
        objects_(objects),
        shared_events_(shared_events),
        signals_(signals),
        signal_wakes_(signal_wakes),
        spawns_(spawns) {}

  // The thread has run since the kernel got the call, which the thread made at `call`. `last`: the
  // thread is known to have come back from the call.
  void Do(Task& task, EventTime call, bool last);

 private:
  RunState& run_;
  KernelObjectWaits& objects_;
  SharedEvents& shared_events_;
  SignalCalls& signals_;
  SignalWakes& signal_wakes_;
  Spawns& spawns_;
};

}  // namespace tcs
