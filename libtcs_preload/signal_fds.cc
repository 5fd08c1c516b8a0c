#include "libtcs_preload/signal_fds.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/signalfd.h>

#include "libtcs_preload/descriptor_path.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

constexpr int kDeepestSet = 4;  // of epoll sets in each other

bool g_any = false;  // this program has made one

// The lines of /proc/self/fdinfo/FD, which says what a descriptor is, whoever made or copied it.
class FdInfo {
 public:
  explicit FdInfo(int fd) {
    const DescriptorPath path("/proc/self/fdinfo/", fd);
    file_ = RawSyscall(SYS_openat, AT_FDCWD, Arg(path.text), O_RDONLY | O_CLOEXEC);
  }
  ~FdInfo() {
    if (file_ >= 0) RawSyscall(SYS_close, file_);
  }
  FdInfo(const FdInfo&) = delete;
  FdInfo& operator=(const FdInfo&) = delete;

  // The next line, or null; what does not fit is cut off.
  const char* Next() {
    std::size_t length = 0;
    for (;; ++at_) {
      if (at_ == filled_) {
        const long got = file_ < 0 ? 0 : RawSyscall(SYS_read, file_, Arg(buffer_), sizeof buffer_);
        if (got <= 0) return nullptr;
        filled_ = static_cast<std::size_t>(got);
        at_ = 0;
      }
      if (buffer_[at_] == '\n') break;
      if (length + 1 < sizeof line_) line_[length++] = buffer_[at_];
    }
    ++at_;
    line_[length] = '\0';
    return line_;
  }

 private:
  long file_;
  std::size_t at_ = 0, filled_ = 0;
  char buffer_[1024], line_[160];
};

// The number after `name` in the line.
bool Find(const char* line, const char* name, int base, std::uint64_t* number) {
  const char* c = strstr(line, name);
  if (c == nullptr) return false;
  c += strlen(name);
  while (*c == ' ' || *c == '\t') ++c;
  *number = 0;
  for (;; ++c) {
    int digit;
    if (*c >= '0' && *c <= '9') {
      digit = *c - '0';
    } else if (*c >= 'a' && *c <= 'f') {
      digit = *c - 'a' + 10;
    } else {
      return true;
    }
    if (digit >= base) return true;
    *number = *number * static_cast<std::uint64_t>(base) + static_cast<std::uint64_t>(digit);
  }
}

unsigned long SignalsIn(int fd, bool* is_epoll, int depth) {
  unsigned long signals = 0;
  FdInfo info(fd);
  while (const char* line = info.Next()) {
    std::uint64_t number;
    if (Find(line, "sigmask:", 16, &number)) return number;
    if (!Find(line, "tfd:", 10, &number)) continue;
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
  while (const char* line = set.Next()) {
    std::uint64_t fd, events, data;
    if (!Find(line, "tfd:", 10, &fd) || !Find(line, "events:", 16, &events) ||
        !Find(line, "data:", 16, &data)) {
      continue;
    }
    bool is_epoll = false;
    if (SignalsOf(static_cast<int>(fd), &is_epoll) == 0) continue;
    if (is_epoll) RearmSignalFds(static_cast<int>(fd));
    epoll_event event{};
    event.events = static_cast<std::uint32_t>(events);
    event.data.u64 = data;
    RawSyscall(SYS_epoll_ctl, epfd, EPOLL_CTL_MOD, static_cast<long>(fd), Arg(&event));
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
