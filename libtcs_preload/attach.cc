#include "libtcs_preload/attach.h"

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "libtcs_preload/descriptor_broker.h"
#include "libtcs_preload/environment.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"
#include "shm/attach_protocol.h"
#include "shm/own_receivers.h"

namespace tcs::preload {

namespace {

shm::ThreadSlot* g_slots = nullptr;

// From this number on, descriptors that are kept are out of the way of programs that count
// descriptors from 0.
constexpr long kWantedFd = 960;
// Up to such a limit of open files a kept descriptor stays beyond the limit, where the program has
// no number. The kernel keeps a table up to the highest number, and copies it for each child.
constexpr rlim64_t kMostBeyond = 4096;

// A program may have used up all its descriptors, and make a thread or a process then, for which it
// needs none. While this object lives there are some more, where the process may raise its limit:
// the descriptors that are kept stay beyond the limit.
class MoreDescriptors {
 public:
  explicit MoreDescriptors(bool wanted) {
    if (!wanted) return;
    RawSyscall(SYS_prlimit64, 0, RLIMIT_NOFILE, 0, Arg(&before_));
    rlimit64 more{before_.rlim_cur + kMore, before_.rlim_max};
    if (more.rlim_max < more.rlim_cur) more.rlim_max = more.rlim_cur;
    has_more_ = before_.rlim_cur != RLIM64_INFINITY &&
                RawSyscall(SYS_prlimit64, 0, RLIMIT_NOFILE, Arg(&more), 0) == 0;
  }
  ~MoreDescriptors() {
    if (has_more_) RawSyscall(SYS_prlimit64, 0, RLIMIT_NOFILE, Arg(&before_), 0);
  }
  MoreDescriptors(const MoreDescriptors&) = delete;
  MoreDescriptors& operator=(const MoreDescriptors&) = delete;

  // The least number that is out of the way of the program's own.
  long Beyond() const {
    const auto limit = static_cast<long>(before_.rlim_cur);
    // A program that wants a number that nobody has takes the limit itself.
    if (has_more_ && before_.rlim_cur <= kMostBeyond) return limit + 2;
    return limit - static_cast<long>(kMore) < kWantedFd ? limit - static_cast<long>(kMore)
                                                        : kWantedFd;
  }

 private:
  static constexpr rlim64_t kMore = 8;
  rlimit64 before_{};
  bool has_more_ = false;
};

// Raises no limit unless it must: another thread that came meanwhile would find the limit raised,
// and leave it so.
long OpenSocket() {
  const auto open = [] {
    return RawSyscall(SYS_socket, AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  };
  const long fd = open();
  if (fd != -EMFILE) return fd;
  const MoreDescriptors more(true);
  return open();
}

int Connect() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t length = strlen(SocketName());
  if (length + 1 > sizeof address.sun_path) DieWithoutCoordinator("TCS_SOCKET is too long");
  memcpy(address.sun_path + 1, SocketName(), length);
  const long fd = OpenSocket();
  if (fd < 0) DieWithoutCoordinator("this process has no free descriptor for the connection to it");
  const long size = static_cast<long>(offsetof(sockaddr_un, sun_path) + 1 + length);
  // A program in a network of its own, as in a sandbox, finds nobody under the name. A call without
  // the mark does, because it is trapped.
  if (RawSyscall(SYS_connect, fd, Arg(&address), size) != 0 &&
      RawSyscall(SYS_connect, fd, Arg(&address), size, 0, 0, 0) != 0) {
    DieWithoutCoordinator("that tcsim is no longer there");
  }
  return static_cast<int>(fd);
}

struct Received {
  shm::AttachReply reply{};
  int fds[shm::kMostAttachFds] = {-1, -1, -1, -1};
  std::int32_t pid = 0, tid = 0;  // of the thread that has asked
};

Received Exchange(int socket, shm::AttachWants wants) {
  shm::AttachHello hello{shm::kMagic, shm::kVersion, 0, 0, 0, wants, 0, 0};
  hello.pid = static_cast<std::int32_t>(RawSyscall(SYS_getpid));
  hello.tid = static_cast<std::int32_t>(RawSyscall(SYS_gettid));
  hello.parent_pid = static_cast<std::int32_t>(RawSyscall(SYS_getppid));
  // Up to glibc 2.42 the word holds the thread's id, from 2.43 on a state.
  RawSyscall(SYS_prctl, PR_GET_TID_ADDRESS, Arg(&hello.end_word), 0, 0, 0);
  RawSocketCall(SYS_sendto, socket, Arg(&hello), sizeof hello, MSG_NOSIGNAL, 0, 0);

  Received received{.pid = hello.pid, .tid = hello.tid};
  iovec iov{&received.reply, sizeof received.reply};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof received.fds)];
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  long n;
  do {
    n = RawSyscall(SYS_recvmsg, socket, Arg(&message), MSG_CMSG_CLOEXEC);
  } while (n == -4 /* EINTR */);
  if (n != static_cast<long>(sizeof received.reply) || received.reply.magic != shm::kMagic ||
      received.reply.version != shm::kVersion) {
    DieWithoutCoordinator("tcsim has no place for it (another version of tcs?)");
  }
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (header != nullptr && header->cmsg_type == SCM_RIGHTS) {
    const std::size_t size = header->cmsg_len - CMSG_LEN(0);
    memcpy(received.fds, CMSG_DATA(header),
           size < sizeof received.fds ? size : sizeof received.fds);
  }
  return received;
}

void MapRun(int fd) {
  const long at = RawSyscall(SYS_mmap, 0, sizeof(shm::PublishedRun), PROT_READ, MAP_SHARED, fd, 0);
  if (at < 0 && at > -4096) DieWithoutCoordinator("the shared memory cannot be mapped");
  g_run = reinterpret_cast<const shm::RunMemory*>(at);
  g_header = &g_run->header;
  if (g_header->magic != shm::kMagic || g_header->version != shm::kVersion ||
      g_header->slot_size != sizeof(shm::ThreadSlot)) {
    DieWithoutCoordinator("the shared memory has another layout (another version of tcs?)");
  }
}

// A child by fork has not inherited its parent's slots. The child's slots go to the same place, if
// that is free: a handler that forked may still look there.
void MapSlots(int fd) {
  constexpr long kSize = static_cast<long>(shm::kProcessMemorySize);
  const auto map = [fd](long where, int how) {
    return RawSyscall(SYS_mmap, where, kSize, PROT_READ | PROT_WRITE, MAP_SHARED | how, fd, 0L);
  };
  const auto failed = [](long at) { return at < 0 && at > -4096; };
  long at = g_slots == nullptr ? -1 : map(Arg(g_slots), MAP_FIXED_NOREPLACE);
  if (failed(at)) at = map(0, 0);
  if (failed(at)) DieWithoutCoordinator("the shared memory cannot be mapped");
  RawSyscall(SYS_madvise, at, kSize, MADV_DONTFORK);
  g_slots = reinterpret_cast<shm::ThreadSlot*>(at);
}

// Moves the descriptor out of the way, as `kept`, which is the parent's before.
void Keep(int fd, int& kept, const MoreDescriptors& more) {
  if (kept >= 0) {
    if (RawSyscall(SYS_dup3, fd, kept, O_CLOEXEC) == kept) {
      RawSyscall(SYS_close, fd);
      return;
    }
    // The number is beyond a limit that the parent has lowered.
    RawSyscall(SYS_close, kept);
  }
  const long moved = RawSyscall(SYS_fcntl, fd, F_DUPFD_CLOEXEC, more.Beyond());
  if (moved >= 0) {
    RawSyscall(SYS_close, fd);
    fd = static_cast<int>(moved);
  }
  kept = fd;
}

}  // namespace

void Attach(GuestThread& thread, unsigned long blocked) {
  // The state that the process has inherited, or that an earlier attach has left, is its own only
  // if one of its threads has a place already.
  const bool is_first = g_process->mode != ProcessState::kAttached;
  const MoreDescriptors more(is_first);
  const int socket = Connect();
  const Received received =
      Exchange(socket, is_first ? shm::AttachWants::kAll : shm::AttachWants::kSlot);
  RawSyscall(SYS_close, socket);
  if (received.reply.refused != 0) DieWithoutCoordinator(received.reply.text);
  if (is_first) {
    if (g_header == nullptr) MapRun(received.fds[0]);
    MapSlots(received.fds[1]);
    Keep(received.fds[2], g_notify_fd, more);
    if (received.fds[3] >= 0) Keep(received.fds[3], g_broker_fd, more);
    RawSyscall(SYS_close, received.fds[0]);
    RawSyscall(SYS_close, received.fds[1]);
  }
  if (received.reply.slot >= shm::kSlotCount) DieWithoutCoordinator("it gave a wrong slot");
  thread.slot = g_slots + received.reply.slot;
  thread.index = received.reply.slot;
  thread.pid = received.pid;
  thread.tid = received.tid;
  thread.slot->blocked_signals = blocked;
  AllowPreemption();
  thread.slot->spin.can_be_asked = OwnSignals() != 0 ? 1 : 0;
  if (is_first && g_header->has_brokers != 0) MakeBroker();
  AwaitFirstDispatch(thread);
}

int OpenDdsArea() {
  const int socket = Connect();
  const Received received = Exchange(socket, shm::AttachWants::kDdsArea);
  RawSyscall(SYS_close, socket);
  return received.fds[0];
}

}  // namespace tcs::preload
