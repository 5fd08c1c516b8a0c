// The reads of the cycle counter, and the pauses, in one image: found, and replaced.
#pragma once

#include "libtcs_preload/cycle_counter/stand_ins.h"
#include "libtcs_preload/cycle_counter/tell_of_reads.h"
#include "shm/machine_code/image.h"

namespace tcs::preload {

// No thread executes code of the image meanwhile, but for this one, elsewhere. Its segments must
// not change. What stands in for its reads. `left`: those of the counter that stay as they are.
StandInMemory* ReplaceReads(const shm::Image& image, const shm::Sought& sought, LeftReads* left);

}  // namespace tcs::preload
