#include "coordinator/port/waits.h"

#include <linux/futex.h>
#include <poll.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "shm/time_values.h"

namespace tcs {

int MakeWaitSet() { return epoll_create1(EPOLL_CLOEXEC); }

bool ChangeWaitSet(int set, int operation, int fd, epoll_event* event) {
  return epoll_ctl(set, operation, fd, event) == 0;
}

std::size_t WaitForEvents(int set, std::span<epoll_event> events, HostDuration timeout) {
  const timespec at_most = shm::ToTimespec(timeout.ns());
  const int found = epoll_pwait2(set, events.data(), static_cast<int>(events.size()),
                                 timeout < HostDuration() ? nullptr : &at_most, nullptr);
  return found < 0 ? 0 : static_cast<std::size_t>(found);
}

void AwaitReadable(int fd, HostDuration at_most) {
  pollfd one{fd, POLLIN, 0};
  const timespec time = shm::ToTimespec(at_most.ns());
  ppoll(&one, 1, &time, nullptr);
}

bool IsReadable(int fd) {
  pollfd one{fd, POLLIN, 0};
  return poll(&one, 1, 0) != 0;
}

ssize_t ReadPipe(int fd, void* to, std::size_t size) { return read(fd, to, size); }

void Pause(HostDuration duration) {
  const timespec time = shm::ToTimespec(duration.ns());
  nanosleep(&time, nullptr);
}

void WakeAt(std::atomic<std::uint32_t>& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE, 1, nullptr, nullptr, 0);
}

}  // namespace tcs
