#include "libtcs_preload/signal_fds.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/signalfd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/fd_info.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

constexpr int kDeepestSet = 4;  // of epoll sets in each other

bool g_any = false;  // this program has made such a descriptor

unsigned long SignalsIn(int fd, bool* is_epoll, int depth) {
  unsigned long signals = 0;
  FdInfo info(fd);
  while (const char* line = info.Next()) {
    std::uint64_t number;
    if (FindNumber(line, "sigmask:", 16, &number)) return number;
    if (!FindNumber(line, "tfd:", 10, &number)) continue;
    *is_epoll = true;
    bool nested = false;
    if (depth < kDeepestSet) signals |= SignalsIn(static_cast<int>(number), &nested, depth + 1);
  }
  return signals;
}

}  // namespace

unsigned long SignalsOf(int fd, bool* is_epoll) {
  *is_epoll = false;
  return __atomic_load_n(&g_any, __ATOMIC_RELAXED) ? SignalsIn(fd, is_epoll, 0) : 0;
}

void RearmSignalFds(int epfd) {
  FdInfo set(epfd);
  EpollMember member;
  while (NextMember(set, &member)) {
    bool is_epoll = false;
    if (SignalsOf(member.fd, &is_epoll) == 0) continue;
    if (is_epoll) RearmSignalFds(member.fd);
    epoll_event event{};
    event.events = member.events;
    event.data.u64 = member.data;
    RawSyscall(SYS_epoll_ctl, epfd, EPOLL_CTL_MOD, member.fd, Arg(&event));
  }
}

}  // namespace tcs::preload

using namespace tcs::preload;

TCS_EXPORT int signalfd(int fd, const sigset_t* set, int flags) noexcept {
  Enter();
  const long made = RawSyscall(SYS_signalfd4, fd, Arg(set), 8, flags);
  if (made >= 0) __atomic_store_n(&g_any, true, __ATOMIC_RELAXED);
  return static_cast<int>(ToErrno(made));
}
