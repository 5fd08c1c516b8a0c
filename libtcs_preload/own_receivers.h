// Datagrams that go to the coordinator itself (shm/own_receivers.h). Async-signal-safe.
#pragma once

#include <sys/socket.h>

namespace tcs::preload {

// Whether nobody but the coordinator receives what is sent by the socket to the address; without
// one, to where the socket is connected.
bool IsForCoordinator(int fd, const void* address, socklen_t size);

}  // namespace tcs::preload
