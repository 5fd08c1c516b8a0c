#include "libtcs_preload/fd_wait.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
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

WaitResult ToResult(WakeReason reason) {
  switch (reason) {
    case WakeReason::kDeadline:
      return WaitResult::kTimedOut;
    case WakeReason::kSignal:
      return WaitResult::kInterrupted;
    case WakeReason::kGo:
    case WakeReason::kCutOff:  // nobody comes back with that
      break;
  }
  return WaitResult::kRetry;
}

}  // namespace

WaitResult WaitForFds(GuestThread& thread, const pollfd* fds, unsigned long count,
                      std::int64_t deadline_ns, const Waiting& waiting) {
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
  int gathered = -1;
  for (unsigned long i = 0; i < count; ++i) {
    bool is_epoll = false;
    if (fds[i].fd < 0 || (SignalsOf(fds[i].fd, &is_epoll) != 0 && !is_epoll)) continue;
    if (n == shm::kMaxWaitFds) {
      gathered = GatherInEpoll(fds, count);
      waited[0] = shm::WaitFd{gathered, EPOLLIN};
      n = 1;
      break;
    }
    waited[n++] = shm::WaitFd{
        fds[i].fd, static_cast<std::uint32_t>(static_cast<unsigned short>(fds[i].events))};
  }
  const Reply reply =
      Exchange(thread, Request{.kind = NotificationKind::kWaitFds,
                               .deadline_ns = deadline_ns,
                               .args = {static_cast<std::int64_t>(waiting.event),
                                        static_cast<std::int64_t>(signals), waiting.again ? 1 : 0},
                               .fds = waited,
                               .fd_count = n,
                               .interruptible = true});
  thread.passes_on = reply.values[1] != 0;
  if (gathered >= 0) RawSyscall(SYS_close, gathered);
  for (unsigned long i = 0; rearm && i < count; ++i) {
    if (fds[i].fd >= 0) RearmSignalFds(fds[i].fd);
  }
  return ToResult(reply.reason);
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

FdState AwaitFd(GuestThread& thread, int fd, short events, std::int64_t deadline_ns, bool looked) {
  if (!looked && IsNonBlocking(fd)) return FdState::kReady;
  const OneEvent event = (events & POLLIN) != 0 ? OneEvent::kForTheFirst : OneEvent::kForAll;
  for (FdState state = FdState::kReady;; state = FdState::kWaited, looked = false) {
    if (!looked && PollNow(fd, events)) return state;
    const pollfd waited{fd, events, 0};
    const bool again = state == FdState::kWaited;
    switch (WaitForFds(thread, &waited, 1, deadline_ns, {event, again})) {
      case WaitResult::kRetry:
        break;
      case WaitResult::kTimedOut:
        if (PollNow(fd, events)) return FdState::kWaited;
        Fail(EAGAIN);
        return FdState::kFailed;
      case WaitResult::kInterrupted:
        // As the kernel has it: with a timeout of its own a socket's wait is never made again.
        if (deadline_ns != shm::kNeverNs || !RestartsAfterSignal()) {
          Fail(EINTR);
          return FdState::kFailed;
        }
        break;
    }
  }
}

bool HoldForReadFrom(GuestThread& thread, int fd, bool socket) {
  if (const TimerFd* timer = socket ? nullptr : FindTimerFd(fd); timer != nullptr) {
    // What of a short interval has run out meanwhile is not in the descriptor yet.
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

bool CanWait(int fd, bool* is_socket) {
  struct stat status;
  if (RawSyscall(SYS_fstat, fd, Arg(&status)) != 0) return false;
  if (is_socket != nullptr) *is_socket = S_ISSOCK(status.st_mode);
  return !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode) && !S_ISBLK(status.st_mode);
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
