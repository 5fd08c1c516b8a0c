// How a process or thread gets its slot from the coordinator.
#pragma once

#include "libtcs_preload/guest.h"

namespace tcs::preload {

// Fills `thread` and returns once the thread has been dispatched for the first time. Ends the
// process where there is no coordinator or it refuses. The caller keeps handlers from running
// meanwhile (without_handlers.h); the caller's program blocks the signals `blocked`.
// Async-signal-safe.
void Attach(GuestThread& thread, unsigned long blocked);

// A descriptor of the process's area of DDS (shm/dds_exchange.h), once the process has joined; -1:
// there is none.
int OpenDdsArea();

}  // namespace tcs::preload
