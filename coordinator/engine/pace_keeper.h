// The run is held back, in real time, before it acts.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "shm/time_kinds.h"

namespace tcs {

class PaceKeeper : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Until the run may act; false if it is to end instead. What comes from outside meanwhile happens
  // at the time that the wall clock stands for. Of the programs nobody runs, so nothing else
  // happens.
  bool Keep();

 private:
  VirtualTime NextAct() const;
  void FlushForWatchers();

  HostTime standing_since_;  // while it stands
  HostTime next_flush_;
};

}  // namespace tcs
