// The coordinator's part of one exchange of shm/attach_protocol.h. A process that connects can
// claim anything; the kernel says which process it is.
//
// For the coordinator's thread only. No function here waits: a client that does not read has lost
// the answer.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <span>

#include "shm/attach_protocol.h"

namespace tcs {

// The process's request, as far as the process has said it; nothing if that is not a hello. The
// numbers in the hello are tcsim's. `peer`: which process has connected, where the kernel does not
// tell that of the connection; 0: the kernel does.
std::optional<shm::AttachHello> PeekHello(int connection, pid_t peer = 0);

struct TakenHello {
  bool has_gone = false;
  // Nothing: the process speaks another protocol, or for another process.
  std::optional<shm::AttachHello> hello;
};
TakenHello TakeHello(int connection, pid_t peer = 0);

void Accept(int connection, std::uint32_t slot, std::span<const int> fds);
// `why` is for the user, after the program's name and pid.
void Refuse(int connection, const char* why);

}  // namespace tcs
