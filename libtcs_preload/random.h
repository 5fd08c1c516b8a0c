// What programs draw from the system: under fixed accounting it repeats, each process with a seed
// of its own.
#pragma once

#include "shm/layout.h"

namespace tcs::preload {

// Starts the process's sequence anew and rewrites AT_RANDOM. Does nothing under measured
// accounting.
void SeedProcess(const shm::ThreadSlot& slot);

// True if the process has been given a seed.
bool DrawsRepeat();

}  // namespace tcs::preload
