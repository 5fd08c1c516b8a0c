// Asking about a file by its name: a device of the robot's is there, under the name that it has in
// the scenario. All other names are the kernel's business.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "libtcs_preload/aliases.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;

namespace {

// The two structures are one here, and the kernel's.
static_assert(sizeof(struct stat) == sizeof(struct stat64));

int StatAt(int folder, const char* path, void* status, int flags) {
  return static_cast<int>(
      ToErrno(RawSyscall(SYS_newfstatat, folder, Arg(FileOf(path)), Arg(status), flags)));
}

}  // namespace

TCS_EXPORT int stat(const char* path, struct stat* status) noexcept {
  return StatAt(AT_FDCWD, path, status, 0);
}
TCS_EXPORT int stat64(const char* path, struct stat64* status) noexcept {
  return StatAt(AT_FDCWD, path, status, 0);
}
TCS_EXPORT int lstat(const char* path, struct stat* status) noexcept {
  return StatAt(AT_FDCWD, path, status, AT_SYMLINK_NOFOLLOW);
}
TCS_EXPORT int lstat64(const char* path, struct stat64* status) noexcept {
  return StatAt(AT_FDCWD, path, status, AT_SYMLINK_NOFOLLOW);
}
TCS_EXPORT int fstatat(int folder, const char* path, struct stat* status, int flags) noexcept {
  return StatAt(folder, path, status, flags);
}
TCS_EXPORT int fstatat64(int folder, const char* path, struct stat64* status, int flags) noexcept {
  return StatAt(folder, path, status, flags);
}
TCS_EXPORT int statx(int folder, const char* path, int flags, unsigned mask,
                     struct statx* status) noexcept {
  return static_cast<int>(
      ToErrno(RawSyscall(SYS_statx, folder, Arg(FileOf(path)), flags, mask, Arg(status))));
}
TCS_EXPORT int access(const char* path, int mode) noexcept {
  return TCS_REAL(access)(FileOf(path), mode);
}
TCS_EXPORT int faccessat(int folder, const char* path, int mode, int flags) noexcept {
  return TCS_REAL(faccessat)(folder, FileOf(path), mode, flags);
}
