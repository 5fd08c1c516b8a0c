// Leads the program's reads of the processor's cycle counter to the virtual one.
#pragma once

namespace tcs::preload {

// Of all that is loaded, and of what will be. Once per program, before it has threads; a child by
// fork inherits it. The thread is attached.
void LeadCounterReads();

}  // namespace tcs::preload
