// Closing and copying descriptors: the shim's own stay open, and its timers follow their
// descriptors.
#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <stdarg.h>
#include <sys/resource.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/kernel_objects.h"
#include "libtcs_preload/linger.h"
#include "libtcs_preload/outside.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/timer_fds.h"

using namespace tcs::preload;

namespace {

// A thread may wait in a call on the descriptor that is about to be closed or replaced.
void NoteChange() {
  const GuestThread* t = IfAttached();
  if (t == nullptr) return;
  std::atomic<std::uint32_t>& changed = t->slot->descriptors_changed;
  changed.store(changed.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

// The kernel refuses a number beyond the limit of open files before it looks at the file that has
// it.
bool IsBeyondLimit(int fd) {
  rlimit64 limit{};
  RawSyscall(SYS_prlimit64, 0, RLIMIT_NOFILE, 0, Arg(&limit));
  return static_cast<rlim64_t>(fd) >= limit.rlim_cur;
}

// A file that was open for others to see is about to be closed.
void BeginClosing(int fd) {
  NoteChange();
  NoteCloses(fd);
  if (g_header == nullptr || g_header->is_unprivileged == 0 || !CanWait(fd)) return;
  if (GuestThread* t = Current(); t != nullptr) BeginChange(*t);
}

void ForgetTimer(int fd) {
  const std::int64_t id = ForgetTimerFd(fd);
  if (id == 0) return;
  if (GuestThread* t = Current(); t != nullptr) {
    Exchange(*t, Request{.kind = tcs::shm::NotificationKind::kTimerDelete, .args = {id}});
  }
}

// With its last descriptor a file's locks end.
long MayUnlock(long result) {
  if (g_header != nullptr && g_header->kernel_waiters.load(std::memory_order_relaxed) != 0) {
    if (GuestThread* t = Current(); t != nullptr) TellKernelWaiters(*t);
  }
  return result;
}

long CloseRange(unsigned first, unsigned last, unsigned flags) {
  if (first > last) return -EINVAL;
  NoteChange();
  if (g_header != nullptr && g_header->is_unprivileged != 0) {
    if (GuestThread* t = Current(); t != nullptr) BeginChange(*t);
  }
  if ((flags & CLOSE_RANGE_CLOEXEC) == 0) {
    for (unsigned fd = first; fd <= last && fd < 1024; ++fd) ForgetTimer(static_cast<int>(fd));
  }
  // Closes around the shim's own descriptors.
  const bool in_order = g_notify_fd < g_broker_fd;
  const long own[] = {in_order ? g_notify_fd : g_broker_fd, in_order ? g_broker_fd : g_notify_fd};
  long from = first, result = 0;
  bool skips = false;
  for (const long fd : own) {
    if (fd < from || fd > static_cast<long>(last)) continue;
    skips = true;
    if (from < fd) result = RawSyscall(SYS_close_range, from, fd - 1, static_cast<int>(flags));
    if (result != 0) return result;
    from = fd + 1;
  }
  if (skips && from > static_cast<long>(last)) return 0;
  return RawSyscall(SYS_close_range, from, last, static_cast<int>(flags));
}

}  // namespace

TCS_EXPORT int close(int fd) {
  if (IsOwnDescriptor(fd)) return Fail(EBADF);
  ForgetTimer(fd);
  LingerBeforeClosing(fd);
  BeginClosing(fd);
  return static_cast<int>(ToErrno(MayUnlock(RawSyscall(SYS_close, fd))));
}

TCS_EXPORT int close_range(unsigned first, unsigned last, int flags) noexcept {
  return static_cast<int>(
      ToErrno(MayUnlock(CloseRange(first, last, static_cast<unsigned>(flags)))));
}

TCS_EXPORT void closefrom(int first) noexcept {
  MayUnlock(CloseRange(first < 0 ? 0u : static_cast<unsigned>(first), ~0u, 0));
}

TCS_EXPORT int dup(int fd) noexcept {
  if (IsOwnDescriptor(fd)) return Fail(EBADF);
  const long copy = RawSyscall(SYS_dup, fd);
  if (copy >= 0) CopyTimerFd(fd, static_cast<int>(copy));
  return static_cast<int>(ToErrno(copy));
}

TCS_EXPORT int dup3(int from, int to, int flags) noexcept {
  if (IsOwnDescriptor(from)) return Fail(EBADF);
  if (IsOwnDescriptor(to)) return Fail(IsBeyondLimit(to) ? EBADF : EBUSY);
  if (from != to && RawSyscall(SYS_fcntl, from, F_GETFD) >= 0) LingerBeforeClosing(to);
  BeginClosing(to);
  const long copy = RawSyscall(SYS_dup3, from, to, flags);
  if (copy >= 0) {
    ForgetTimer(to);
    CopyTimerFd(from, to);
  }
  return static_cast<int>(ToErrno(MayUnlock(copy)));
}

TCS_EXPORT int dup2(int from, int to) noexcept {
  if (from != to) return dup3(from, to, 0);
  return RawSyscall(SYS_fcntl, from, F_GETFD) < 0 ? Fail(EBADF) : to;
}
