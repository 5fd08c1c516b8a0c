// Opening files: one end of a FIFO waits for the other, and the opening of an end ends others'
// waits. All other files are opened by the kernel, at no cost but a look at what they are.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>

#include "libtcs_preload/aliases.h"
#include "libtcs_preload/computer_files.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/kernel_objects.h"
#include "libtcs_preload/kernel_wait.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

bool IsFifo(int folder, const char* path, int flags) {
  struct stat status;
  const int follow = (flags & O_NOFOLLOW) != 0 ? AT_SYMLINK_NOFOLLOW : 0;
  return RawSyscall(SYS_newfstatat, folder, Arg(path), Arg(&status), follow) == 0 &&
         S_ISFIFO(status.st_mode);
}

bool WaitsForOtherEnd(int flags) {
  return (flags & (O_NONBLOCK | O_PATH | O_DIRECTORY)) == 0 && (flags & O_ACCMODE) != O_RDWR;
}

// Makes `call`, which opens `path` with `flags`.
template <class Call>
auto Opening(int folder, const char* path, int flags, bool cancellable, Call call) {
  GuestThread* t = Current();
  if (t == nullptr || IsShutDown() || path == nullptr) return call();
  const bool waits = WaitsForOtherEnd(flags);
  const bool ends_waits = g_header->kernel_waiters.load(std::memory_order_relaxed) != 0;
  if (!(waits || ends_waits) || !IsFifo(folder, path, flags)) return call();
  Enter();
  HoldForRead(*t);
  HoldForWrite(*t);
  if (waits) Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kKernelWait});
  int before = 0;
  if (waits && cancellable) pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, &before);
  const auto result = call();
  const int saved = errno;
  if (waits && cancellable) pthread_setcanceltype(before, nullptr);
  TellKernelWaiters(*t);
  errno = saved;
  return result;
}

// Opens a device of the robot's. Data that has come while nobody had the device open is not there,
// as at a real port.
int OpenDevice(int folder, const char* file, int flags, mode_t mode) {
  const Entered t;
  if (t != nullptr) HoldForRead(*t);
  const long fd = RawSyscall(SYS_openat, folder, Arg(file), flags, static_cast<long>(mode));
  if (fd >= 0 && t != nullptr) RawSyscall(SYS_ioctl, fd, TCFLSH, TCIFLUSH);
  return static_cast<int>(ToErrno(fd));
}

FILE* OfDevice(FILE* stream) {
  const Entered t;
  if (stream == nullptr || t == nullptr) return stream;
  HoldForRead(*t);
  RawSyscall(SYS_ioctl, fileno(stream), TCFLSH, TCIFLUSH);
  return stream;
}

int OpenAt(int folder, const char* path, int flags, mode_t mode) {
  const char* file = FileOf(path);
  if (file != path) return OpenDevice(folder, file, flags, mode);
  if (Current() != nullptr) pthread_testcancel();
  if (MayBeOfComputer(folder, path, flags)) {
    return static_cast<int>(ToErrno(OpenOfComputer(folder, path, flags)));
  }
  const long fd = Opening(folder, path, flags, true, [&] {
    return RawSyscall(SYS_openat, folder, Arg(path), flags, static_cast<long>(mode));
  });
  if (fd >= 0 && IsDeviceOutside(path)) NoteOpens(static_cast<int>(fd));
  return static_cast<int>(ToErrno(fd));
}

// Only a mode with + opens for both.
int FlagsOf(const char* mode) {
  if (mode == nullptr || strchr(mode, '+') != nullptr) return O_RDWR;
  return mode[0] == 'r' ? O_RDONLY : O_WRONLY;
}

}  // namespace

// The mode is there where a file may be made.
#define TCS_MODE(flags)                           \
  mode_t mode = 0;                                \
  if (((flags) & (O_CREAT | __O_TMPFILE)) != 0) { \
    va_list arguments;                            \
    va_start(arguments, flags);                   \
    mode = va_arg(arguments, mode_t);             \
    va_end(arguments);                            \
  }

TCS_EXPORT int open(const char* path, int flags, ...) {
  TCS_MODE(flags)
  return OpenAt(AT_FDCWD, path, flags, mode);
}

TCS_EXPORT int open64(const char* path, int flags, ...) {
  TCS_MODE(flags)
  return OpenAt(AT_FDCWD, path, flags, mode);
}

TCS_EXPORT int openat(int folder, const char* path, int flags, ...) {
  TCS_MODE(flags)
  return OpenAt(folder, path, flags, mode);
}

TCS_EXPORT int openat64(int folder, const char* path, int flags, ...) {
  TCS_MODE(flags)
  return OpenAt(folder, path, flags, mode);
}

// The aliases that the fortified headers call, where the flags make no file.
TCS_EXPORT int __open_2(const char* path, int flags) { return OpenAt(AT_FDCWD, path, flags, 0); }
TCS_EXPORT int __open64_2(const char* path, int flags) { return OpenAt(AT_FDCWD, path, flags, 0); }
TCS_EXPORT int __openat_2(int folder, const char* path, int flags) {
  return OpenAt(folder, path, flags, 0);
}
TCS_EXPORT int __openat64_2(int folder, const char* path, int flags) {
  return OpenAt(folder, path, flags, 0);
}

TCS_EXPORT int creat(const char* path, mode_t mode) {
  return OpenAt(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}
TCS_EXPORT int creat64(const char* path, mode_t mode) { return creat(path, mode); }

TCS_EXPORT FILE* fopen(const char* path, const char* mode) {
  if (const char* file = FileOf(path); file != path) return OfDevice(TCS_REAL(fopen)(file, mode));
  return Opening(AT_FDCWD, path, FlagsOf(mode), false, [&] { return TCS_REAL(fopen)(path, mode); });
}

TCS_EXPORT FILE* fopen64(const char* path, const char* mode) {
  if (const char* file = FileOf(path); file != path) return OfDevice(TCS_REAL(fopen64)(file, mode));
  return Opening(AT_FDCWD, path, FlagsOf(mode), false,
                 [&] { return TCS_REAL(fopen64)(path, mode); });
}

TCS_EXPORT FILE* freopen(const char* path, const char* mode, FILE* stream) {
  if (const char* file = FileOf(path); file != path) {
    return OfDevice(TCS_REAL(freopen)(file, mode, stream));
  }
  return Opening(AT_FDCWD, path, FlagsOf(mode), false,
                 [&] { return TCS_REAL(freopen)(path, mode, stream); });
}

TCS_EXPORT FILE* freopen64(const char* path, const char* mode, FILE* stream) {
  if (const char* file = FileOf(path); file != path) {
    return OfDevice(TCS_REAL(freopen64)(file, mode, stream));
  }
  return Opening(AT_FDCWD, path, FlagsOf(mode), false,
                 [&] { return TCS_REAL(freopen64)(path, mode, stream); });
}
