// The notifications that threads send through their process's pipe. The handlers look again where
// what is waited for may be there already, and be found at this very moment.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class NotificationReceiver : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Takes notifications of one process, so many at a time: other processes have their turns, too.
  PollOutcome Take(const Process& process, EventTime when);
  // Answers what the thread has said last, at the thread's own time. True if there may be more by
  // now that belongs to this moment. If a handler has come meanwhile, what the handler interrupted
  // is answered first: the coordinator may not have heard of it yet.
  bool Handle(Task& task);

 private:
  void HandlerCame(Task& task, EventTime when);
  PollOutcome Arrived(Task& task, EventTime when);
  bool PutOff(Task& task);
};

}  // namespace tcs
