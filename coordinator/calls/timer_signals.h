// The signals of timers, sent at their instant. A signal that becomes pending, is ignored or ends
// the process is sent at once. A signal with a handler is sent at the dispatch of the thread that
// will run the handler, because the handler is that thread's work.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>

#include "coordinator/calls/signal_wakes.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class TimerSignals {
 public:
  TimerSignals(RunState& run, Waker& waker, SignalWakes& wakes)
      : run_(run), waker_(waker), wakes_(wakes) {}

  // Routes the signals that the process's timers have to send.
  void Route(Process& process, EventTime when);
  // Sends the signals that have waited for the dispatch of this thread, which is now.
  static void SendTo(const Task& task);
  // Finds out which timers' signals have been accepted by `now`. A signal counts as not accepted
  // while a signal of its number is pending where it was sent to: whose that is cannot be seen. A
  // signal that does nothing is dropped by the kernel once it is no longer blocked; its overruns
  // are the expirations until `now`.
  void NoteAccepted(Process& process, VirtualTime now) const;
  // Whether the timer's signal that was sent last may be pending still.
  static bool IsPending(const Process& process, std::int64_t timer_id);

 private:
  static pid_t AccepterOf(const Process& process, const TimerSignal& signal);
  Task* TakerOf(const Process& process, const TimerSignal& signal) const;
  // Whether nobody will hear of the signal.
  bool IsLost(const Process& process, int number, pid_t tid) const;

  RunState& run_;
  Waker& waker_;
  SignalWakes& wakes_;
};

}  // namespace tcs
