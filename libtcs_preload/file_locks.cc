// Locks of files: flock, fcntl's and lockf. The kernel is asked for what it can do at once; where
// it can do nothing at once the kernel holds the thread, keeps the order and finds deadlocks.
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <sys/file.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/kernel_objects.h"
#include "libtcs_preload/kernel_wait.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/timer_fds.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// A lock has its place in time: no thread may take or give one at an earlier time any more.
// `at_once` and `waiting` are the call in its two forms, the latter null where it does not wait.
template <class AtOnce, class Waiting>
long Lock(GuestThread& t, bool waits, bool cancellable, AtOnce at_once, Waiting waiting) {
  HoldForRead(t);
  HoldForWrite(t);
  long result = at_once();
  // Even a call that fails may have given up the lock that was to be changed.
  TellKernelWaiters(t);
  if (!waits || (result != -EAGAIN && result != -EACCES)) return result;
  result = WaitInKernel(t, cancellable, waiting);
  TellKernelWaiters(t);
  return result;
}

bool IsLock(int command) {
  return command == F_SETLK || command == F_SETLKW || command == F_OFD_SETLK ||
         command == F_OFD_SETLKW;
}

long LockRecord(GuestThread& t, int fd, int command, long lock) {
  const bool waits = command == F_SETLKW || command == F_OFD_SETLKW;
  const int at_once = command == F_SETLKW       ? F_SETLK
                      : command == F_OFD_SETLKW ? F_OFD_SETLK
                                                : command;
  return Lock(
      t, waits, true, [&] { return RawSyscall(SYS_fcntl, fd, at_once, lock); },
      [&] { return RawSyscall(SYS_fcntl, fd, command, lock); });
}

long Control(int fd, int command, long argument) {
  if (IsLock(command)) {
    const Entered t;
    if (t != nullptr && !IsShutDown()) return LockRecord(*t, fd, command, argument);
  }
  const long result = RawSyscall(SYS_fcntl, fd, command, argument);
  if (result >= 0 && (command == F_DUPFD || command == F_DUPFD_CLOEXEC)) {
    CopyTimerFd(fd, static_cast<int>(result));
  }
  return result;
}

int LockSection(int fd, int command, off_t length) {
  struct flock lock {};
  lock.l_whence = SEEK_CUR;
  lock.l_len = length;
  lock.l_type = command == F_ULOCK ? F_UNLCK : F_WRLCK;
  switch (command) {
    case F_LOCK:
      return static_cast<int>(ToErrno(Control(fd, F_SETLKW, Arg(&lock))));
    case F_TLOCK:
    case F_ULOCK:
      return static_cast<int>(ToErrno(Control(fd, F_SETLK, Arg(&lock))));
    default:
      return TCS_REAL(lockf)(fd, command, length);
  }
}

}  // namespace

TCS_EXPORT int flock(int fd, int operation) noexcept {
  const Entered t;
  auto call = [&](int with) { return RawSyscall(SYS_flock, fd, with); };
  if (t == nullptr || IsShutDown()) return static_cast<int>(ToErrno(call(operation)));
  const bool waits = (operation & (LOCK_NB | LOCK_UN)) == 0;
  return static_cast<int>(ToErrno(Lock(
      *t, waits, false, [&] { return call(operation | LOCK_NB); },
      [&] { return call(operation); })));
}

TCS_EXPORT int fcntl(int fd, int command, ...) {
  va_list arguments;
  va_start(arguments, command);
  const long argument = va_arg(arguments, long);  // an int or a pointer, or nothing
  va_end(arguments);
  // The C library makes this command by a newer call of the kernel, for owners below zero.
  if (command == F_GETOWN) return TCS_REAL(fcntl)(fd, command);
  return static_cast<int>(ToErrno(Control(fd, command, argument)));
}

TCS_EXPORT int fcntl64(int fd, int command, ...) {
  va_list arguments;
  va_start(arguments, command);
  const long argument = va_arg(arguments, long);
  va_end(arguments);
  return fcntl(fd, command, argument);
}

TCS_EXPORT int lockf(int fd, int command, off_t length) { return LockSection(fd, command, length); }

TCS_EXPORT int lockf64(int fd, int command, off64_t length) {
  return LockSection(fd, command, length);
}
