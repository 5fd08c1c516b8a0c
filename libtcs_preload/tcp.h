// Functions that keep the kernel's own timers out of TCP. They do nothing to other sockets; errno
// is kept.
#pragma once

namespace tcs::preload {

// Data that is written to `fd` is sent at once, however little it is and whatever is still
// unacknowledged.
void SendAtOnce(int fd);

// The next read acknowledges what it takes. False: the socket is no TCP socket.
bool AcknowledgeAtOnce(int fd);

bool IsTcp(int fd);

}  // namespace tcs::preload
