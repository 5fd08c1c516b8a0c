// Leads the program's reads of the processor's cycle counter to the virtual one, and its pauses to
// where they are counted.
#pragma once

#include "shm/machine_code/counter_reads.h"

namespace tcs::preload {

// Leads what is sought in all images that are loaded, and that will be. Once per program, before it
// has threads; a child by fork inherits it. The thread is attached.
void LeadReads(const shm::Sought& sought);

}  // namespace tcs::preload
