#include "coordinator/os/timer_descriptor.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <string>

#include "coordinator/os/open_files.h"
#include "shm/clock_ids.h"

namespace tcs {

namespace {

// TFD_IOC_SET_TICKS of <linux/timerfd.h>, which cannot be had beside the C library's header.
constexpr unsigned long kSetTicks = _IOW('T', 0, std::uint64_t);

// A number in the lines about the descriptor; 0 where there is none.
std::uint64_t NumberInInfo(int fd, const std::string& name) {
  std::ifstream file("/proc/self/fdinfo/" + std::to_string(fd));
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(name + ": ", 0) == 0) return std::stoull(line.substr(name.size() + 2));
  }
  return 0;
}

std::uint64_t Unread(int timer_fd) {
  pollfd probe{timer_fd, POLLIN, 0};
  return poll(&probe, 1, 0) == 1 ? NumberInInfo(timer_fd, "ticks") : 0;
}

}  // namespace

bool IsTimerDescriptor(int fd) { return IsAnonymous(getpid(), fd, kTimerFd); }

bool IsOfRealtime(int timer_fd) {
  const auto clock = static_cast<clockid_t>(NumberInInfo(timer_fd, "clockid"));
  return shm::ClockOf(clock).kind == shm::ClockKind::kRealtime;
}

bool AddExpirations(int timer_fd, std::int64_t count) {
  if (count <= 0) return false;
  const std::uint64_t before = Unread(timer_fd);
  auto ticks = static_cast<std::uint64_t>(count);
  ticks = ticks > std::numeric_limits<std::uint64_t>::max() - before
              ? std::numeric_limits<std::uint64_t>::max()
              : ticks + before;
  if (ioctl(timer_fd, kSetTicks, &ticks) == 0) return true;
  // A kernel without that (CONFIG_CHECKPOINT_RESTORE) can at least be told of one expiration.
  const itimerspec past{{0, 0}, {0, 1}};
  return timerfd_settime(timer_fd, TFD_TIMER_ABSTIME, &past, nullptr) == 0;
}

void ForgetExpirations(int timer_fd) {
  const itimerspec never{};
  timerfd_settime(timer_fd, 0, &never, nullptr);
}

}  // namespace tcs
