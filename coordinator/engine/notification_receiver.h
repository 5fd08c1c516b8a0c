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
  Reactor::Found Take(const Process& process, Moment moment);

 private:
  Reactor::Found Arrived(Task& task, Moment moment);
  bool PutOff(Task& task);
};

}  // namespace tcs
