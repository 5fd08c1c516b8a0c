// Datagrams that go to the coordinator itself (shm/own_receivers.h). Async-signal-safe.
#pragma once

#include <sys/socket.h>

#include "libtcs_preload/guest.h"
#include "shm/own_receivers.h"

namespace tcs::preload {

// Which of the coordinator's receivers alone gets what the socket sends to the address; without an
// address, to where the socket is connected. kNoReceiver: programs may get it.
int ReceiverOf(int fd, const void* address, socklen_t size);

// Sends the message to the receiver without the kernel, through the thread's command ring
// (shm/command_ring.h), at the time that the thread's clock has shown. False, and nothing has
// happened: the kernel has to carry this one. `result` is what the kernel would return: bytes, or
// -errno.
bool Post(GuestThread& thread, int fd, int receiver, const msghdr& message, int flags,
          long* result);

}  // namespace tcs::preload
