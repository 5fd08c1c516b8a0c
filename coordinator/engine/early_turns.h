// Turns on another processor: how they begin before their order, and end in it (turns_beside.h).
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class EarlyTurns : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Before the first virtual CPU acts: begins turns of the virtual CPUs that act soon after it, and
  // need not wait for it.
  void Begin();
  // The turn has its order: the turn ends now, at the time at which its thread stopped.
  void Take(Task& task);

 private:
  void BeginOn(VirtualCpu& cpu);
};

}  // namespace tcs
