// Things that need not be looked at in each step: the detector, processors that others claim,
// people who watch, a run that stands still.
#pragma once

#include <cstdint>

#include "coordinator/engine/engine_part.h"

namespace tcs {

class Lookout : public EnginePart {
 public:
  using EnginePart::EnginePart;

  void Look();

 private:
  int shows_ = 0;
  std::uint64_t next_look_tsc_ = 0;
};

}  // namespace tcs
