// Where nobody acts: idle time is jumped over, unless somebody may come back whom nobody sees.
#pragma once

#include <optional>

#include "coordinator/engine/engine_part.h"
#include "shm/time_kinds.h"

namespace tcs {

class IdleTime : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Before idle time is jumped over: false if there is somebody to act first.
  bool HasJumpedOver();
  // Nobody acts by itself any more, and no world goes on. False at the run's end.
  bool AwaitOutside();
  void WaitOutside();
  void WaitForDebugger();
  // Threads for which the run goes on. At its end all are waited for.
  int Living() const;
  // All threads have said that they end; the kernel is about to end their processes. False once
  // that is over.
  bool AwaitExits();
  // What was waited for before counts no more.
  void StartAnew() { idle_at_.reset(); }

 private:
  std::optional<VirtualTime> idle_at_;  // where nobody acts by itself,
  HostTime idle_since_;                 // and since when
};

}  // namespace tcs
