#include "libtcs_preload/memory_devices.h"

#include <sys/sysmacros.h>

#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

bool IsMemoryDevice(const struct stat& status) {
  constexpr unsigned kMemoryMajor = 1, kLogMinor = 11;
  return S_ISCHR(status.st_mode) && major(status.st_rdev) == kMemoryMajor &&
         minor(status.st_rdev) != kLogMinor;
}

bool IsMemoryDevice(int fd) {
  struct stat status;
  return RawSyscall(SYS_fstat, fd, Arg(&status)) == 0 && IsMemoryDevice(status);
}

}  // namespace tcs::preload
