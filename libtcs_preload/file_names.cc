// Asking about a file by its name: a device of the robot's is there, under the name that it has in
// the scenario. All other names are the kernel's business.
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "libtcs_preload/aliases.h"
#include "libtcs_preload/computer_files.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;

namespace {

// The two structures are one here, and the kernel's.
static_assert(sizeof(struct stat) == sizeof(struct stat64));

// The answer of the kernel; for files in the folders of the robot's processors, of `ask(fd)`. The
// kernel comes first, because it knows whether the name can be read at all.
template <class Ask, class Kernel>
long OfProcessors(const char* path, bool follows, Ask ask, Kernel kernel) {
  const long found = kernel();
  if (found == -EFAULT) return found;
  const long fd = OpenProcessorFolder(path, follows ? 0 : O_NOFOLLOW);
  if (fd == -ENOENT || fd == -ENOTDIR) return fd;
  if (fd < 0) return found;
  const long result = ask(fd);
  RawSyscall(SYS_close, fd);
  return result;
}

bool Follows(int flags) { return (flags & AT_SYMLINK_NOFOLLOW) == 0; }

int StatAt(int folder, const char* path, void* status, int flags) {
  return static_cast<int>(ToErrno(OfProcessors(
      path, Follows(flags),
      [&](long fd) { return RawSyscall(SYS_newfstatat, fd, Arg(""), Arg(status), AT_EMPTY_PATH); },
      [&] { return RawSyscall(SYS_newfstatat, folder, Arg(FileOf(path)), Arg(status), flags); })));
}

int AccessAt(int folder, const char* path, int mode, int flags) {
  const auto kernel = [&]() -> long {
    const int result = TCS_REAL(faccessat)(folder, FileOf(path), mode, flags);
    return result == 0 ? 0 : -errno;
  };
  return static_cast<int>(ToErrno(OfProcessors(
      path, Follows(flags),
      [&](long fd) { return RawSyscall(SYS_faccessat2, fd, Arg(""), mode, AT_EMPTY_PATH); },
      kernel)));
}

// The functions that programs built with glibc up to 2.32 call in their place, because the header
// makes such a call of each. `version` says which structure the program knows.
int OldStatAt(int version, int folder, const char* path, void* status, int flags) {
  constexpr int kKernels = 0, kLibrarys = 1;  // the same structure
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
  return static_cast<int>(ToErrno(OfProcessors(
      path, Follows(flags),
      [&](long fd) { return RawSyscall(SYS_statx, fd, Arg(""), AT_EMPTY_PATH, mask, Arg(status)); },
      [&] { return RawSyscall(SYS_statx, folder, Arg(FileOf(path)), flags, mask, Arg(status)); })));
}
TCS_EXPORT int access(const char* path, int mode) noexcept {
  return AccessAt(AT_FDCWD, path, mode, 0);
}
TCS_EXPORT int faccessat(int folder, const char* path, int mode, int flags) noexcept {
  return AccessAt(folder, path, mode, flags);
}
