// Signals that clients send to each other, and those that come from outside.
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <utility>

#include "coordinator/calls/child_stops.h"
#include "coordinator/calls/signal_wakes.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class SignalCalls {
 public:
  // How often signals are looked for that no notification tells of.
  static constexpr HostDuration kLookEvery = HostDuration::Milliseconds(10);

  // `looked_at`: a signal may have stopped the process or let it go on, at that time.
  SignalCalls(RunState& run, Waker& waker, SignalWakes& wakes, ChildStops& stops,
              const RunClock& clock, std::function<void(const Process&, VirtualTime)> looked_at)
      : run_(run),
        waker_(waker),
        wakes_(wakes),
        stops_(stops),
        clock_(clock),
        looked_at_(std::move(looked_at)) {}

  // A program has sent a signal.
  void Sent(const SentSignal& signal, EventTime when);
  // No notification says that a signal has come from outside, so the threads that wait for one are
  // looked at now and then. True if one of them goes on.
  bool Poll();

 private:
  RunState& run_;
  Waker& waker_;
  SignalWakes& wakes_;
  ChildStops& stops_;
  const RunClock& clock_;
  std::function<void(const Process&, VirtualTime)> looked_at_;
  std::uint64_t next_look_tsc_ = 0;
  int unseen_ = 0;  // threads that the kernel had in its hands at the last look
};

}  // namespace tcs
