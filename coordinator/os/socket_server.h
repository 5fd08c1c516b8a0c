// The socket that serves an address on this computer.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <optional>

namespace tcs {

// The inode of the socket that gets what the connected socket `fd` sends to `peer`: the listener of
// a TCP socket's, the receiver of a UDP socket's. 0: there is none in the network that this thread
// is in. None: the kernel does not say (it has no sock_diag, or refuses it).
std::optional<std::uint64_t> ServerOf(int fd, const sockaddr_storage& peer);

}  // namespace tcs
