// How far a thread may run in its next turn.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class Horizons : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // `idle_until`: the thread may sleep that far without asking, for nothing else happens on its
  // virtual CPU before.
  VirtualTime Of(Task& task, VirtualTime* idle_until);
  // Under --sync callback: how long the world waits for a program that computes, and how long it
  // still waits.
  VirtualDuration MostHeld() const;
  VirtualDuration LeftToHold(const Task& task) const;
};

}  // namespace tcs
