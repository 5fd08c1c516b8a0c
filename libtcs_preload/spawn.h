// Telling the coordinator of a new child: virtual time does not pass it by while it starts.
#pragma once

#include <sys/types.h>

#include "libtcs_preload/guest.h"

namespace tcs::preload {

void TellSpawned(GuestThread& thread, pid_t pid);

}  // namespace tcs::preload
