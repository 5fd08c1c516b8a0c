// Asking about a file by its name: a device of the robot's is there, under the name that it has in
// the scenario. All other names are the kernel's business.
#include <errno.h>
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

// What programs call in their place that were built with glibc up to 2.32, whose header has such a
// call made of each: it says first which structure the program knows.
int OldStatAt(int version, int folder, const char* path, void* status, int flags) {
  constexpr int kKernels = 0, kLibrarys = 1;  // the same one
  if (version != kKernels && version != kLibrarys) return Fail(EINVAL);
  return StatAt(folder, path, status, flags);
}

}  // namespace

extern "C" {
TCS_EXPORT int __xstat(int version, const char* path, struct stat* status) noexcept {
  return OldStatAt(version, AT_FDCWD, path, status, 0);
}
TCS_EXPORT int __xstat64(int version, const char* path, struct stat64* status) noexcept {
  return OldStatAt(version, AT_FDCWD, path, status, 0);
}
TCS_EXPORT int __lxstat(int version, const char* path, struct stat* status) noexcept {
  return OldStatAt(version, AT_FDCWD, path, status, AT_SYMLINK_NOFOLLOW);
}
TCS_EXPORT int __lxstat64(int version, const char* path, struct stat64* status) noexcept {
  return OldStatAt(version, AT_FDCWD, path, status, AT_SYMLINK_NOFOLLOW);
}
TCS_EXPORT int __fxstatat(int version, int folder, const char* path, struct stat* status,
                          int flags) noexcept {
  return OldStatAt(version, folder, path, status, flags);
}
TCS_EXPORT int __fxstatat64(int version, int folder, const char* path, struct stat64* status,
                            int flags) noexcept {
  return OldStatAt(version, folder, path, status, flags);
}
}

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
