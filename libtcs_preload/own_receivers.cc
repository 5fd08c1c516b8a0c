#include "libtcs_preload/own_receivers.h"

#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "shm/own_receivers.h"

namespace tcs::preload {

bool IsForCoordinator(int fd, const void* address, socklen_t size) {
  const shm::OwnReceivers& receivers = shm::OwnReceiversOf(*g_run);
  if (receivers.count == 0) return false;
  sockaddr_storage peer;
  if (address == nullptr) {
    size = sizeof peer;
    if (RawSyscall(SYS_getpeername, fd, Arg(&peer), Arg(&size)) != 0) return false;
    address = &peer;
  } else if (size > sizeof peer || !CanRead(address, size)) {
    return false;
  }
  return shm::IsAmong(receivers, shm::AddressOf(address, size));
}

}  // namespace tcs::preload
