// What threads say through their process's pipe. They look again where what is waited for may be
// there already, and be found at this very moment.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class NotificationReceiver : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Of one process, so many at a time: others have their turns, too.
  PollOutcome Take(const Process& process, EventTime when);
  // What the thread has said last is answered, at its own time. True if there may be more by now
  // that belongs to this moment. If a handler has come meanwhile, what the handler interrupted is
  // answered first: nobody may have heard of it yet.
  bool Handle(Task& task);
  // The thread is about to have its turn. If a signal was to end its wait, and none is there for
  // it, it waits on.
  void TakeAgainIfUnmarked(Task& task);

 private:
  void HandlerCame(Task& task, EventTime when);
  PollOutcome Arrived(Task& task, EventTime when);
  bool PutOff(Task& task);
};

}  // namespace tcs
