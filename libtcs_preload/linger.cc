#include "libtcs_preload/linger.h"

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <string.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/tcp.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/last_descriptor.h"

namespace tcs::preload {

namespace {

// A socket of this process lingers, or of one that it was forked from.
std::atomic<bool> g_lingers{false};

// How often the thread looks at a socket that does not tell when all of its data has been sent.
constexpr std::int64_t kLookEveryNs = 1'000'000;

int Asked(int fd, unsigned long what) {
  int value = 0;
  return RawSyscall(SYS_ioctl, fd, static_cast<long>(what), Arg(&value)) == 0 ? value : 0;
}

// 0: closing does not wait.
std::int64_t LingersFor(int fd) {
  linger asked{};
  socklen_t size = sizeof asked;
  const long result =
      RawSyscall(SYS_getsockopt, fd, SOL_SOCKET, SO_LINGER, Arg(&asked), Arg(&size));
  if (result != 0 || asked.l_onoff == 0 || asked.l_linger <= 0 || !IsTcp(fd)) return 0;
  return std::int64_t{asked.l_linger} * 1'000'000'000;
}

// The kernel waits for nothing more of a connection that has ended.
bool IsConnected(int fd) {
  std::uint8_t state = TCP_CLOSE;
  socklen_t size = sizeof state;
  RawSyscall(SYS_getsockopt, fd, IPPROTO_TCP, TCP_INFO, Arg(&state), Arg(&size));
  return state == TCP_ESTABLISHED || state == TCP_CLOSE_WAIT || state == TCP_FIN_WAIT1 ||
         state == TCP_CLOSING || state == TCP_LAST_ACK;
}

// Data that the other end has no room for is not sent yet. Unread data at this end resets the
// connection.
bool MayWait(int fd) {
  return Asked(fd, SIOCOUTQNSD) != 0 && Asked(fd, SIOCINQ) == 0 && IsConnected(fd);
}

// Only the last descriptor lingers. Where nobody answers the descriptor is taken for the last one.
bool IsLast(int fd) {
  return RawSyscall(SYS_futex, 0, static_cast<long>(shm::kIsLastDescriptor), fd) != 0;
}

// The socket shows room only once nothing is left to be sent.
class RoomIfAllSent {
 public:
  explicit RoomIfAllSent(int fd) : fd_(fd) {
    socklen_t size = sizeof before_;
    RawSyscall(SYS_getsockopt, fd_, IPPROTO_TCP, TCP_NOTSENT_LOWAT, Arg(&before_), Arg(&size));
    Set(1);
  }
  ~RoomIfAllSent() { Set(before_); }
  RoomIfAllSent(const RoomIfAllSent&) = delete;
  RoomIfAllSent& operator=(const RoomIfAllSent&) = delete;

 private:
  void Set(int value) const {
    RawSyscall(SYS_setsockopt, fd_, IPPROTO_TCP, TCP_NOTSENT_LOWAT, Arg(&value), sizeof value);
  }

  const int fd_;
  int before_ = 0;
};

// False: a signal has come. A socket that was shut down always shows room.
bool AwaitRoom(GuestThread& thread, int fd, std::int64_t deadline_ns) {
  if (PollNow(fd, POLLOUT)) return SleepUntil(thread, deadline_ns);
  const pollfd waited{fd, POLLOUT, 0};
  return WaitForFds(thread, &waited, 1, deadline_ns) != WaitResult::kInterrupted;
}

void Await(GuestThread& thread, int fd, std::int64_t linger_ns) {
  const RoomIfAllSent room(fd);
  const std::int64_t deadline_ns = AddSaturated(NowNs(thread), linger_ns);
  while (MayWait(fd)) {
    const std::int64_t now_ns = NowNs(thread);
    if (now_ns >= deadline_ns) return;
    const std::int64_t look_ns = std::min(deadline_ns, AddSaturated(now_ns, kLookEveryNs));
    if (!AwaitRoom(thread, fd, look_ns)) return;
  }
}

}  // namespace

void NoteLinger(const void* value, socklen_t size) {
  linger asked{};
  if (size < sizeof asked) return;
  memcpy(&asked, value, sizeof asked);
  if (asked.l_onoff != 0 && asked.l_linger > 0) g_lingers.store(true, std::memory_order_relaxed);
}

void LingerBeforeClosing(int fd) {
  if (!g_lingers.load(std::memory_order_relaxed)) return;
  const std::int64_t linger_ns = LingersFor(fd);
  if (linger_ns == 0) return;
  const Entered t;
  if (t == nullptr || IsShutDown() || !IsLast(fd)) return;
  Await(*t, fd, linger_ns);
  const linger off{};
  RawSyscall(SYS_setsockopt, fd, SOL_SOCKET, SO_LINGER, Arg(&off), sizeof off);
}

}  // namespace tcs::preload
