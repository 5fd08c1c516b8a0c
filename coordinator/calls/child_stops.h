// Processes that a signal stops, and that go on. Other processes see the change at once, even if
// none of the process's threads has its turn, and the parents learn of it.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include "coordinator/calls/signal_wakes.h"
#include "coordinator/host/active_threads.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class ChildStops {
 public:
  ChildStops(RunState& run, Waker& waker, SignalWakes& wakes, ActiveThreads& active)
      : run_(run), waker_(waker), wakes_(wakes), active_(active) {}

  // If the process has stopped or gone on since the last look, its parent hears of it.
  void Look(Process& process, EventTime when);
  // No notification says that a process has been stopped from outside. So the processes whose
  // parents wait for such a stop are looked at.
  void LookAtAwaited(EventTime when);
  // A child has ended, or, `by_stop`, has stopped or gone on: the parent's threads that wait for
  // such a change look at it, and its signal is there.
  void ChildChanged(Process& parent, pid_t child, bool by_stop, EventTime when);

 private:
  void LetStop(const Process& process);
  void LetGoOn(const Process& process);

  RunState& run_;
  Waker& waker_;
  SignalWakes& wakes_;
  ActiveThreads& active_;
};

}  // namespace tcs
