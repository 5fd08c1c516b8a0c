// The engine: a run from its first moment to its report. The engine's parts are named in wiring.h;
// the loop (loop.h) lets them act.
#pragma once

#include "coordinator/engine/wiring.h"

namespace tcs {

class Engine {
 public:
  Engine(const Scenario& scenario, const RunOptions& options)
      : all_(scenario, options, AskHost()) {}
  RunReport Run();

 private:
  Wiring all_;
};

}  // namespace tcs
