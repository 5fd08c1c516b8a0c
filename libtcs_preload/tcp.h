// What keeps the kernel's own timers out of TCP. Does nothing to other sockets; errno is kept.
#pragma once

namespace tcs::preload {

// What is written to `fd` is sent at once, however little it is and whatever is still
// unacknowledged.
void SendAtOnce(int fd);

// The next read acknowledges what it takes. False: it is no TCP.
bool AcknowledgeAtOnce(int fd);

bool IsTcp(int fd);

}  // namespace tcs::preload
