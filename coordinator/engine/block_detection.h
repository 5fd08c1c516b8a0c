// The consequences of the block detector's report that the running thread does not run.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class BlockDetection : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // The running thread does not run. True if others get their turn; otherwise the thread is waited
  // for: it is starting, or in the disk's hands, and its virtual CPU stands still until the thread
  // goes on.
  bool LetsOthersRun();

  // Without the detector the first thread that waits in the kernel would make all others wait with
  // it: the run fails.
  void DetectorEnded();
  void LookAtDetector();

 private:
  bool CutsOff(Task& task);
};

}  // namespace tcs
