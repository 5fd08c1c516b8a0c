// The world as a leaf of the run: how far it goes on, and when.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class WorldLeaf : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // There is a world, and it has not stopped for the run's end.
  bool GoesOn() const;
  // Advances the dynamics where the virtual CPUs have come to what is due there, or have left them
  // behind. False if neither is so.
  bool Step();
  // The thread is about to run up to its horizon: the dynamics lead it. Returns how far it may run.
  VirtualTime KeepNear(const Task& task, VirtualTime horizon);
  // How far the run has come: of the world and all virtual CPUs the furthest.
  VirtualTime FurthestOfRun() const;
};

}  // namespace tcs
