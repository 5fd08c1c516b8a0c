// System calls of clients that the kernel hands over: which thread makes a call, and whether the
// call concerns the coordinator.
#pragma once

#include <vector>

#include "coordinator/engine/engine_part.h"
#include "coordinator/port/traps.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class TrapReceiver : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // A trapped call has arrived. A call of the running thread stops the thread like a notification.
  PollOutcome Arrived(int listener, EventTime when);
  // The makers of threads have gone on, so that it is known which threads the calls are of.
  void TakeCallsOfNewborns(EventTime when);
  // A signal was to end the thread's wait, but the kernel has none for the thread: the thread's
  // call is taken as one that it makes again.
  void TakeAgainIfUnmarked(Task& task);

 private:
  PollOutcome Take(const TrappedCall& call, EventTime when);
  Task* TaskOf(const TrappedCall& call);

  std::vector<TrappedCall> unborn_calls_;  // of threads that are to be known soon
};

}  // namespace tcs
