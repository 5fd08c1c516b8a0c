#include "libtcs_preload/fd_wait.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "libtcs_preload/call_file.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/memory_devices.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/signal_actions.h"
#include "libtcs_preload/signal_fds.h"
#include "libtcs_preload/timer_fds.h"
#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

namespace {

using shm::NotificationKind;
using shm::WakeReason;

// poll and epoll use the same bits for what can be asked for.
static_assert(POLLIN == EPOLLIN && POLLOUT == EPOLLOUT && POLLPRI == EPOLLPRI &&
              POLLRDHUP == EPOLLRDHUP);

// More descriptors than a record holds become one: an epoll set.
int GatherInEpoll(const pollfd* fds, unsigned long count) {
  const int set = static_cast<int>(RawSyscall(SYS_epoll_create1, EPOLL_CLOEXEC));
  if (set < 0) return set;
  for (unsigned long i = 0; i < count; ++i) {
    if (fds[i].fd < 0) continue;
    epoll_event event{};
    event.events = static_cast<std::uint32_t>(static_cast<unsigned short>(fds[i].events));
    RawSyscall(SYS_epoll_ctl, set, EPOLL_CTL_ADD, fds[i].fd, Arg(&event));
  }
  return set;
}

}  // namespace

WaitResult ResultOf(WakeReason reason) {
  switch (reason) {
    case WakeReason::kDeadline:
      return WaitResult::kTimedOut;
    case WakeReason::kSignal:
      return WaitResult::kInterrupted;
    case WakeReason::kGo:
    case WakeReason::kCutOff:  // no thread comes back with that
      break;
  }
  return WaitResult::kRetry;
}

WaitResult WaitForFds(GuestThread& thread, const pollfd* fds, unsigned long count,
                      std::int64_t deadline_ns, const Waiting& waiting) {
  thread.keeps_files = false;
  if (IsShutDown()) {
    const timespec turn{0, 10'000'000};
    const long n = RawSyscall(SYS_ppoll, Arg(const_cast<pollfd*>(fds)), static_cast<long>(count),
                              Arg(&turn), 0, 0);
    return n == -EINTR ? WaitResult::kInterrupted : WaitResult::kRetry;
  }
  shm::WaitFd waited[shm::kMaxWaitFds];
  std::uint32_t n = 0;
  unsigned long signals = waiting.signals;
  bool rearm = false;
  for (unsigned long i = 0; i < count; ++i) {
    bool is_epoll = false;
    const unsigned long its = fds[i].fd < 0 ? 0 : SignalsOf(fds[i].fd, &is_epoll);
    signals |= its;
    rearm |= its != 0 && is_epoll;
  }
  shm::KeepFiles keep = waiting.keep;
  int gathered = -1;
  for (unsigned long i = 0; i < count; ++i) {
    bool is_epoll = false;
    if (fds[i].fd < 0) continue;
    if (SignalsOf(fds[i].fd, &is_epoll) != 0 && !is_epoll) {
      if (keep == shm::KeepFiles::kForCall) waited[n++] = shm::WaitFd{fds[i].fd, 0};
      continue;
    }
    if (n == shm::kMaxWaitFds) {
      gathered = GatherInEpoll(fds, count);
      waited[0] = shm::WaitFd{gathered, EPOLLIN};
      n = 1;
      keep = shm::KeepFiles::kNot;
      break;
    }
    waited[n++] = shm::WaitFd{
        fds[i].fd, static_cast<std::uint32_t>(static_cast<unsigned short>(fds[i].events))};
  }
  const Reply reply = Exchange(
      thread,
      Request{.kind = NotificationKind::kWaitFds,
              .deadline_ns = deadline_ns,
              .args = {static_cast<std::int64_t>(waiting.event), static_cast<std::int64_t>(signals),
                       waiting.again ? 1 : 0, static_cast<std::int64_t>(keep)},
              .fds = waited,
              .fd_count = n,
              .interruptible = true});
  thread.passes_on = reply.values[1] != 0;
  thread.keeps_files = reply.values[0] != 0 && reply.reason != WakeReason::kSignal;
  if (gathered >= 0) RawSyscall(SYS_close, gathered);
  for (unsigned long i = 0; rearm && i < count; ++i) {
    if (fds[i].fd >= 0) RearmSignalFds(fds[i].fd);
  }
  return ResultOf(reply.reason);
}

void PassOn(GuestThread& thread) {
  if (!thread.passes_on) return;
  thread.passes_on = false;
  Exchange(thread, Request{.kind = NotificationKind::kPassOn});
}

bool PollNow(int fd, short events) {
  pollfd probe{fd, events, 0};
  const timespec now{};
  return RawSyscall(SYS_ppoll, Arg(&probe), 1, Arg(&now), 0, 0) != 0;
}

FdState AwaitEvent(CallFile& file, short events, std::int64_t deadline_ns, bool again) {
  const OneEvent event = (events & POLLIN) != 0 ? OneEvent::kForTheFirst : OneEvent::kForAll;
  for (;;) {
    switch (file.Wait(events, deadline_ns, {.event = event, .again = again})) {
      case WaitResult::kRetry:
        return FdState::kWaited;
      case WaitResult::kTimedOut:
        return FdState::kTimedOut;
      case WaitResult::kInterrupted:
        // As the kernel has it: with a timeout of its own a socket's wait is never made again.
        if (deadline_ns != shm::kNeverNs || !RestartsAfterSignal()) {
          Fail(EINTR);
          return FdState::kFailed;
        }
        // The file that its number means now is looked at.
        if (PollNow(file.fd(), events)) return FdState::kWaited;
        break;
    }
  }
}

FdState AwaitFd(CallFile& file, short events, std::int64_t deadline_ns) {
  if (IsNonBlocking(file.fd()) || PollNow(file.fd(), events)) return FdState::kReady;
  for (bool again = false;; again = true) {
    const FdState state = AwaitEvent(file, events, deadline_ns, again);
    if (state == FdState::kFailed) return state;
    if (PollNow(file.fd(), events)) return FdState::kWaited;
    if (state != FdState::kTimedOut) continue;
    Fail(EAGAIN);
    return FdState::kFailed;
  }
}

bool HoldForReadFrom(GuestThread& thread, int fd, bool socket) {
  if (const TimerFd* timer = socket ? nullptr : FindTimerFd(fd); timer != nullptr) {
    // Expirations of a timer of a short interval are not in the descriptor yet.
    if (timer->is_short) {
      Exchange(thread, Request{.kind = NotificationKind::kTimerGet, .args = {timer->id}});
    }
    return false;
  }
  if (NowNs(thread) <= thread.slot->clock.read_safe_ns) return false;
  int type = 0;
  socklen_t size = sizeof type;
  if (socket && RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_TYPE, Arg(&type), Arg(&size)) == 0 &&
      type == SOCK_DGRAM && PollNow(fd, POLLIN)) {
    return false;
  }
  HoldForRead(thread);
  return true;
}

bool IsNonBlocking(int fd) {
  const long flags = RawSyscall(SYS_fcntl, fd, F_GETFL);
  return flags < 0 || (flags & O_NONBLOCK) != 0;
}

bool CanWait(int fd, FdKind* kind) {
  struct stat status;
  if (RawSyscall(SYS_fstat, fd, Arg(&status)) != 0) return false;
  if (kind != nullptr) {
    *kind = S_ISSOCK(status.st_mode)         ? FdKind::kSocket
            : (status.st_mode & S_IFMT) == 0 ? FdKind::kWithoutName
                                             : FdKind::kOther;
  }
  return !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode) && !S_ISBLK(status.st_mode) &&
         !IsMemoryDevice(status);
}

std::int64_t SocketDeadline(GuestThread& thread, int fd, int option) {
  timeval timeout{};
  socklen_t size = sizeof timeout;
  if (RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, option, Arg(&timeout), Arg(&size)) != 0 ||
      ToNs(timeout) == 0) {
    return shm::kNeverNs;
  }
  return AddSaturated(NowNs(thread), ToNs(timeout));
}

}  // namespace tcs::preload
