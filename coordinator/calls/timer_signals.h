// The signals of timers, sent at their instant: at once where they become pending, are ignored or
// end the process; at the dispatch of the thread that will run a handler, for the handler is its
// work.
//
// For the coordinator's thread only.
#pragma once

#include "coordinator/calls/signal_wakes.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class TimerSignals {
 public:
  TimerSignals(RunState& run, Waker& waker, SignalWakes& wakes)
      : run_(run), waker_(waker), wakes_(wakes) {}

  // Those that the process's timers have to send.
  void Route(Process& process, Moment moment);
  // Those that wait for the dispatch of this thread, which is now.
  static void SendTo(const Task& task);
  // Finds out which timers' signals have been accepted. While one of a signal's number is pending
  // where it was sent to it counts as not: whose it is cannot be seen.
  static void NoteAccepted(Process& process);

 private:
  static pid_t AccepterOf(const Process& process, const TimerSignal& signal);
  Task* TakerOf(const Process& process, const TimerSignal& signal) const;

  RunState& run_;
  Waker& waker_;
  SignalWakes& wakes_;
};

}  // namespace tcs
