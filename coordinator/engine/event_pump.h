// What the kernel has to say is taken, all that there is at an instant, and handled as something of
// that instant.
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

  static constexpr HostDuration kNoWait{};  // what is there is looked at, and nothing waited for

  // All that there is at this instant: were the rest found later, it would have happened later. A
  // negative timeout: none. What is found happens at `when`, or at the time that the running
  // thread has come to.
  PollOutcome Poll(HostDuration timeout, EventTime when);
  // The same for the running thread, in turns while somebody waits for signals. True if it has to
  // stop.
  bool PollWhileRunning(Task& task, HostDuration timeout);
  // One look. `is_rest`: a further look at an instant, at which the running thread stands as it was
  // found.
  PollOutcome LookOnce(HostDuration timeout, EventTime when, bool is_rest);

  // A descriptor that the thread waits for has become ready: all such threads are woken together.
  void NoteReady(Task& task) { ready_awaiters_.push_back(&task); }

 private:
  PollOutcome WakeReadyAwaiters(EventTime when);

  std::vector<Task*> ready_awaiters_;  // whose descriptors have become ready just now
};

}  // namespace tcs
