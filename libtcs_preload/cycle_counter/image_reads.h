// The reads of the cycle counter in one image: found, and replaced.
#pragma once

#include "libtcs_preload/cycle_counter/stand_ins.h"
#include "shm/machine_code/image.h"

namespace tcs::preload {

struct LeftReads {
  std::size_t count = 0;  // that could not be replaced
  shm::Code first = nullptr;

  void Add(shm::Code read) {
    if (count++ == 0) first = read;
  }
};

// No thread executes code of the image meanwhile, but for this one, elsewhere. Its segments must
// not change. What stands in for its reads.
StandInMemory* ReplaceReads(const shm::Image& image, LeftReads* left);

}  // namespace tcs::preload
