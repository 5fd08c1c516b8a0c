// Datagrams that go to the coordinator itself (shm/own_receivers.h). Async-signal-safe.
#pragma once

#include <sys/socket.h>

namespace tcs::preload {

// Whether only the coordinator receives what the socket sends to the address; without an address,
// to where the socket is connected.
bool IsForCoordinator(int fd, const void* address, socklen_t size);

}  // namespace tcs::preload
