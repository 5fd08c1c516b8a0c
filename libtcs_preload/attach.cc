#include "libtcs_preload/attach.h"

#include <fcntl.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "libtcs_preload/environment.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/raw_syscall.h"
#include "shm/attach_protocol.h"

namespace tcs::preload {

namespace {

constexpr int kWantedNotifyFd = 960;  // out of the way of programs that count descriptors from 0

int Connect() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t length = strlen(SocketName());
  if (length + 1 > sizeof address.sun_path) DieWithoutCoordinator("TCS_SOCKET is too long");
  memcpy(address.sun_path + 1, SocketName(), length);
  const long fd = RawSyscall(SYS_socket, AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (fd < 0) DieWithoutCoordinator("no descriptor is left for the connection to it");
  const long size = static_cast<long>(offsetof(sockaddr_un, sun_path) + 1 + length);
  if (RawSyscall(SYS_connect, fd, Arg(&address), size) != 0) {
    DieWithoutCoordinator("that tcsim is no longer there");
  }
  return static_cast<int>(fd);
}

struct Received {
  shm::AttachReply reply{};
  int fds[2] = {-1, -1};
};

Received Exchange(int socket) {
  shm::AttachHello hello{shm::kMagic, shm::kVersion, 0, 0, 0};
  hello.pid = static_cast<std::int32_t>(RawSyscall(SYS_getpid));
  hello.tid = static_cast<std::int32_t>(RawSyscall(SYS_gettid));
  hello.parent_pid = static_cast<std::int32_t>(RawSyscall(SYS_getppid));
  RawSocketCall(SYS_sendto, socket, Arg(&hello), sizeof hello, MSG_NOSIGNAL, 0, 0);

  Received received;
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
    DieWithoutCoordinator("it does not get a place there (another version of tcs?)");
  }
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (header != nullptr && header->cmsg_type == SCM_RIGHTS) {
    memcpy(received.fds, CMSG_DATA(header), sizeof received.fds);
  }
  return received;
}

void MapSegment(int memfd) {
  const long at = RawSyscall(SYS_mmap, 0, static_cast<long>(shm::kSegmentSize),
                             PROT_READ | PROT_WRITE, MAP_SHARED, memfd, 0);
  if (at < 0 && at > -4096) DieWithoutCoordinator("the shared memory cannot be mapped");
  g_header = reinterpret_cast<shm::SegmentHeader*>(at);
  if (g_header->magic != shm::kMagic || g_header->version != shm::kVersion ||
      g_header->slot_size != sizeof(shm::ThreadSlot)) {
    DieWithoutCoordinator("the shared memory has another layout (another version of tcs?)");
  }
}

void KeepNotifyFd(int fd) {
  rlimit64 limit{};
  RawSyscall(SYS_prlimit64, 0, RLIMIT_NOFILE, 0, Arg(&limit));
  const long room = static_cast<long>(limit.rlim_cur) - 8;
  const long moved =
      RawSyscall(SYS_fcntl, fd, F_DUPFD_CLOEXEC, room < kWantedNotifyFd ? room : kWantedNotifyFd);
  if (moved >= 0) {
    RawSyscall(SYS_close, fd);
    fd = static_cast<int>(moved);
  }
  g_notify_fd = fd;
}

}  // namespace

void Attach(GuestThread& thread) {
  const int socket = Connect();
  const Received received = Exchange(socket);
  RawSyscall(SYS_close, socket);
  if (received.reply.refused != 0) DieWithoutCoordinator(received.reply.text);
  // A forked child has inherited the mapping and the pipe.
  if (g_header == nullptr) {
    MapSegment(received.fds[0]);
    KeepNotifyFd(received.fds[1]);
  } else {
    RawSyscall(SYS_close, received.fds[1]);
  }
  RawSyscall(SYS_close, received.fds[0]);
  if (received.reply.slot >= shm::kSlotCount) DieWithoutCoordinator("it gave a wrong slot");
  thread.slot = shm::SlotAt(g_header, received.reply.slot);
  thread.index = received.reply.slot;
  AwaitFirstDispatch(thread);
}

}  // namespace tcs::preload
