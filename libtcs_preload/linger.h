// Closing a TCP socket that lingers (SO_LINGER): until the other end has room for all that was
// written, or the time to linger is over. The kernel would hold the thread in the host's time, and
// wait for the last acknowledgement besides, which it delays by its own timers (tcp.h).
#pragma once

#include <sys/socket.h>

namespace tcs::preload {

// Notes what the program sets SO_LINGER to. From the first socket that lingers on, closing asks.
void NoteLinger(const void* value, socklen_t size);

// Waits, in virtual time, for what closing the descriptor waits for. Afterwards the kernel closes
// the socket without waiting. Does nothing to other descriptors, nor where another descriptor, in
// any process of the run, is of the same socket; errno is kept.
void LingerBeforeClosing(int fd);

}  // namespace tcs::preload
