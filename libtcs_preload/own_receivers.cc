#include "libtcs_preload/own_receivers.h"

#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"

namespace tcs::preload {

int ReceiverOf(int fd, const void* address, socklen_t size) {
  const shm::OwnReceivers& receivers = shm::OwnReceiversOf(*g_run);
  if (receivers.count == 0) return shm::kNoReceiver;
  sockaddr_storage peer;
  if (address == nullptr) {
    size = sizeof peer;
    if (RawSyscall(SYS_getpeername, fd, Arg(&peer), Arg(&size)) != 0) return shm::kNoReceiver;
    address = &peer;
  } else if (size > sizeof peer || !CanRead(address, size)) {
    return shm::kNoReceiver;
  }
  return shm::PlaceAmong(receivers, shm::AddressOf(address, size));
}

}  // namespace tcs::preload
