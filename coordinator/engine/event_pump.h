// Takes the events that the kernel has to report, all that there are at an instant, and handles
// them as events of that instant.
#pragma once

#include <vector>

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class EventPump : public EnginePart {
 public:
  using EnginePart::EnginePart;

  static constexpr HostDuration kNoWait{};  // looks at what is there, and waits for nothing

  // Handles all events that there are at this instant: were the rest found later, it would have
  // happened later. A negative timeout: none. The events happen at `when`, or at the time that the
  // running thread has come to.
  PollOutcome Poll(HostDuration timeout, EventTime when);
  // The same for the running thread, in turns while a thread waits for signals. True if the running
  // thread has to stop.
  bool PollWhileRunning(Task& task, HostDuration timeout);
  // A single look. `is_rest`: a further look at an instant, at which the running thread stands as
  // it was found.
  PollOutcome LookOnce(HostDuration timeout, EventTime when, bool is_rest);

  // A descriptor that the thread waits for has become ready: all such threads are woken together.
  void NoteReady(Task& task) { ready_awaiters_.push_back(&task); }

 private:
  PollOutcome WakeReadyAwaiters(EventTime when);

  std::vector<Task*> ready_awaiters_;  // whose descriptors have become ready just now
};

}  // namespace tcs
