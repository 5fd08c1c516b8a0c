#include "coordinator/tasks/remote_descriptor.h"

#include <fcntl.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "coordinator/os/open_files.h"
#include "coordinator/os/timer_descriptor.h"
#include "coordinator/port/pidfds.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

// Datagrams wait for room where they arrive, too, which is for so many of them. How many there are
// is guessed from the size of the next one.
bool MayBeFullOf(std::int64_t bytes, std::int64_t used) {
  constexpr std::int64_t kBesideEach = 1024;  // of a datagram's memory
  static const int most = [] {
    std::ifstream file("/proc/sys/net/unix/max_dgram_qlen");
    int value = 0;
    return file >> value ? value : 0;
  }();
  return used / (std::max<std::int64_t>(bytes, 0) + kBesideEach) >= most;
}

}  // namespace

UniqueFd CopyOfDescriptor(const Process& process, int number) {
  if (process.broker != nullptr) return process.broker->CopyOf(number);
  return UniqueFd(DuplicateFd(process.pidfd.get(), number));
}

RemoteDescriptor::RemoteDescriptor(const Task& task, int fd)
    : fd_(CopyOfDescriptor(*task.process, fd)) {}

bool RemoteDescriptor::CanWait() const {
  struct stat status;
  if (fd() < 0 || fstat(fd(), &status) != 0) return false;
  return !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode) && !S_ISBLK(status.st_mode);
}

bool RemoteDescriptor::IsNonBlocking() const { return (fcntl(fd(), F_GETFL) & O_NONBLOCK) != 0; }

void RemoteDescriptor::AcknowledgeAtOnce() const {
  const int on = 1;
  setsockopt(fd(), IPPROTO_TCP, TCP_QUICKACK, &on, sizeof on);
}

bool RemoteDescriptor::IsReady(short events) const {
  pollfd probe{fd(), events, 0};
  return poll(&probe, 1, 0) != 0;
}

bool RemoteDescriptor::HasRoomFor(std::int64_t bytes) const {
  std::uint32_t memory[SK_MEMINFO_VARS] = {};
  socklen_t size = sizeof memory;
  if (getsockopt(fd(), SOL_SOCKET, SO_MEMINFO, memory, &size) != 0) return false;
  const std::int64_t whole = memory[SK_MEMINFO_SNDBUF];
  const std::int64_t used = std::max(memory[SK_MEMINFO_WMEM_ALLOC], memory[SK_MEMINFO_WMEM_QUEUED]);
  // With less than a quarter used poll says no for another reason, as that there is no connection
  // yet (unix_writable has the quarter, others more).
  if (used * 4 <= whole || used >= whole) return false;
  int unsent = 0;  // bytes that a TCP socket keeps at most
  size = sizeof unsent;
  if (getsockopt(fd(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent, &size) == 0 && unsent > 0) {
    return false;
  }
  const bool is_stream = SocketOption(SO_TYPE, SOCK_STREAM) == SOCK_STREAM;
  const bool is_local = SocketOption(SO_DOMAIN, AF_UNIX) == AF_UNIX;
  return is_stream || !is_local || !MayBeFullOf(bytes, used);
}

bool RemoteDescriptor::IsEventFd() const { return IsAnonymous(getpid(), fd(), kEventFd); }

bool RemoteDescriptor::IsTimer() const { return IsTimerDescriptor(fd()); }

bool RemoteDescriptor::IsTerminal() const { return tcs::IsTerminal(fd()); }

bool RemoteDescriptor::CanBeRead() const { return (fcntl(fd(), F_GETFL) & O_ACCMODE) != O_WRONLY; }

bool RemoteDescriptor::CanBeWritten() const {
  return (fcntl(fd(), F_GETFL) & O_ACCMODE) != O_RDONLY;
}

int RemoteDescriptor::SocketOption(int option, int otherwise) const {
  int value = 0;
  socklen_t size = sizeof value;
  return getsockopt(fd(), SOL_SOCKET, option, &value, &size) == 0 ? value : otherwise;
}

std::int64_t RemoteDescriptor::SocketTimeout(int option) const {
  timeval timeout{};
  socklen_t size = sizeof timeout;
  if (getsockopt(fd(), SOL_SOCKET, option, &timeout, &size) != 0) return shm::kNeverNs;
  const std::int64_t ns = shm::ToNs(timeout);
  return ns == 0 ? shm::kNeverNs : ns;
}

}  // namespace tcs
