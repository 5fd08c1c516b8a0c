// Where no thread acts: idle time is jumped over, unless a thread may come back that the
// coordinator does not see.
#pragma once

#include <optional>

#include "coordinator/engine/engine_part.h"
#include "shm/time_kinds.h"

namespace tcs {

class IdleTime : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Before idle time is jumped over: false if there is a thread to act first.
  bool HasJumpedOver();
  // No thread acts by itself any more, and no world goes on. False at the run's end.
  bool AwaitOutside();
  void WaitOutside();
  void WaitForDebugger();
  // The threads for which the run goes on. At the run's end all threads are waited for.
  int Living() const;
  // All threads have said that they end; the kernel is about to end their processes. False once
  // that is over.
  bool AwaitExits();
  // The earlier wait counts no more.
  void StartAnew() { idle_at_.reset(); }

 private:
  std::optional<VirtualTime> idle_at_;  // where no thread acts by itself,
  HostTime idle_since_;                 // and since when
};

}  // namespace tcs
