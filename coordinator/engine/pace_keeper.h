// The run is held back, in real time, before it acts.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "shm/time_kinds.h"

namespace tcs {

class PaceKeeper : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Waits until the run may act; false if the run is to end instead. An event from outside happens
  // meanwhile at the time that the wall clock stands for. No program runs, so nothing else happens.
  bool Keep();

 private:
  VirtualTime NextAct() const;
  void FlushForWatchers();

  HostTime standing_since_;  // while the run stands
  HostTime next_flush_;
};

}  // namespace tcs
