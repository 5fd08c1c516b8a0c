// The reads of the cycle counter, and the pauses, in one image: found, and replaced.
#pragma once

#include "libtcs_preload/cycle_counter/stand_ins.h"
#include "libtcs_preload/cycle_counter/tell_of_reads.h"
#include "shm/machine_code/image.h"

namespace tcs::preload {

// Returns the stand-ins for the image's reads. No thread executes code of the image meanwhile, but
// for the calling thread, elsewhere. The image's segments must not change. `left`: the reads of the
// counter that stay as they are.
StandInMemory* ReplaceReads(const shm::Image& image, const shm::Sought& sought, LeftReads* left);

}  // namespace tcs::preload
