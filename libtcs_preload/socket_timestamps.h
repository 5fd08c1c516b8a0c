// The time at which the kernel says that something has arrived at a socket (SO_TIMESTAMP and its
// kin): the host's, replaced by the virtual time at which it is read.
#pragma once

#include <sys/socket.h>

namespace tcs::preload {

// Replaces the times in a message that has just been received.
void ReplaceTimestamps(msghdr* message);

}  // namespace tcs::preload
