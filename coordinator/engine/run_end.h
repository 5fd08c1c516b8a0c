// The orderly end of a run, once it has concluded.
#pragma once

#include "coordinator/engine/engine_part.h"

namespace tcs {

class RunEnd : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // The clients that still live get their grace (grace.h), in which the loop goes on for them.
  void EndClients();
  // Kills the processes that are left now.
  void Shutdown();

 private:
  void BeginGrace();
};

}  // namespace tcs
