#include "coordinator/os/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace tcs {

namespace {

constexpr int kSealFutureWrite = 0x0010;  // F_SEAL_FUTURE_WRITE, of Linux 5.1

// The memory is sealed only once it is mapped, for then nobody else maps it for writing.
SharedMemory Make(const char* name, std::size_t size, int seals) {
  UniqueFd fd(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!fd || fchmod(fd.get(), 0600) != 0 || ftruncate(fd.get(), static_cast<off_t>(size)) != 0) {
    return {};
  }
  void* at = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0);
  if (at == MAP_FAILED) return {};
  if (fcntl(fd.get(), F_ADD_SEALS, seals) == 0) return {std::move(fd), at};
  const int error = errno;
  munmap(at, size);
  errno = error;
  return {};
}

}  // namespace

SharedMemory MakeSharedMemory(const char* name, std::size_t size) {
  return Make(name, size, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL);
}

SharedMemory MakePublishedMemory(const char* name, std::size_t size) {
  return Make(name, size, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL | kSealFutureWrite);
}

}  // namespace tcs
