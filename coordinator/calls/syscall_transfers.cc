#include "coordinator/calls/syscall_transfers.h"

#include <errno.h>
#include <limits.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/tasks/remote_descriptor.h"

namespace tcs {

namespace {

constexpr std::int64_t kCounter = sizeof(std::uint64_t);  // bytes that eventfds and timerfds give

struct Transfer {
  bool reads = false;
  bool of_sockets = false;  // rather than of any descriptor
  int flags = 0;            // MSG_*, or of accept4
};

Transfer TransferOf(const TrappedCall& call) {
  switch (call.number) {
    case SYS_read:
    case SYS_readv:
      return {.reads = true};
    case SYS_recvfrom:
    case SYS_recvmmsg:
    case SYS_accept4:
      return {.reads = true, .of_sockets = true, .flags = static_cast<int>(call.args[3])};
    case SYS_recvmsg:
      return {.reads = true, .of_sockets = true, .flags = static_cast<int>(call.args[2])};
    case SYS_accept:
      return {.reads = true, .of_sockets = true};
    case SYS_sendto:
    case SYS_sendmmsg:
      return {.of_sockets = true, .flags = static_cast<int>(call.args[3])};
    case SYS_sendmsg:
      return {.of_sockets = true, .flags = static_cast<int>(call.args[2])};
    case SYS_connect:
      return {.of_sockets = true};
    default:
      return {};
  }
}

// The bytes that read, write and their kin are to transfer; -1: the kernel refuses the call.
std::int64_t BytesOf(const Task& task, const TrappedCall& call) {
  if (call.number == SYS_read || call.number == SYS_write) {
    return static_cast<std::int64_t>(std::min<std::uint64_t>(call.args[2], INT_MAX));
  }
  const auto count = static_cast<int>(call.args[2]);
  if (count < 0 || count > IOV_MAX) return -1;
  std::vector<iovec> iov(static_cast<std::size_t>(count));
  if (count > 0 &&
      !ReadMemory(task.process->pid, call.args[1], iov.data(), iov.size() * sizeof iov[0])) {
    return -1;
  }
  std::int64_t bytes = 0;
  for (const iovec& part : iov) {
    bytes += static_cast<std::int64_t>(std::min<std::size_t>(part.iov_len, INT_MAX));
  }
  return bytes;
}

// 0: the number is not known.
std::int64_t BytesToSend(const Task& task, const TrappedCall& call) {
  if (call.number == SYS_sendto) return static_cast<std::int64_t>(call.args[2]);
  const bool writes = call.number == SYS_write || call.number == SYS_writev;
  return writes ? BytesOf(task, call) : 0;
}

// Whether the kernel answers though the descriptor is not ready: nothing was asked for, or
// something is wrong.
bool FileAnswersAtOnce(const Task& task, const TrappedCall& call, const RemoteDescriptor& fd,
                       bool reads) {
  const std::int64_t bytes = BytesOf(task, call);
  if (bytes <= 0 || !(reads ? fd.CanBeRead() : fd.CanBeWritten())) return true;
  if (fd.IsTimer()) return !reads || bytes < kCounter;
  return bytes < kCounter && fd.IsEventFd();
}

// False if the kernel refuses the message that recvmsg or sendmsg is given.
bool IsMessage(const Task& task, const TrappedCall& call) {
  if (call.number != SYS_recvmsg && call.number != SYS_sendmsg) return true;
  msghdr message{};
  return ReadMemory(task.process->pid, call.args[1], &message, sizeof message) &&
         message.msg_iovlen <= IOV_MAX;
}

// Whether something is wrong with a socket, asked for in a way that takes and gives nothing.
bool SocketFailsAtOnce(const RemoteDescriptor& fd, int flags, bool reads) {
  char byte;
  if (reads) {
    return recv(fd.fd(), &byte, 1, (flags & MSG_OOB) | MSG_PEEK | MSG_DONTWAIT) < 0 &&
           errno != EAGAIN;
  }
  return fd.SocketOption(SO_TYPE, -1) == SOCK_STREAM &&
         send(fd.fd(), &byte, 0, MSG_DONTWAIT | MSG_NOSIGNAL) < 0 && errno != EAGAIN;
}

bool SocketAnswersAtOnce(const TrappedCall& call, const RemoteDescriptor& fd,
                         const Transfer& transfer) {
  const int flags = transfer.flags;
  if (call.number == SYS_connect) return true;
  if (call.number == SYS_accept || call.number == SYS_accept4) {
    return (flags & ~(SOCK_CLOEXEC | SOCK_NONBLOCK)) != 0 || fd.SocketOption(SO_ACCEPTCONN, 0) == 0;
  }
  if ((flags & MSG_DONTWAIT) != 0) return true;
  const bool several = call.number == SYS_recvmmsg || call.number == SYS_sendmmsg;
  if (several && static_cast<unsigned>(call.args[2]) == 0) return true;
  if (transfer.reads && (flags & MSG_ERRQUEUE) != 0) {
    return fd.SocketOption(SO_DOMAIN, AF_UNIX) != AF_UNIX;
  }
  return SocketFailsAtOnce(fd, flags, transfer.reads);
}

bool AnswersAtOnce(const Task& task, const TrappedCall& call, const RemoteDescriptor& fd,
                   const Transfer& transfer) {
  const bool is_socket = fd.SocketOption(SO_TYPE, -1) >= 0;
  if (transfer.of_sockets) {
    return !is_socket || !IsMessage(task, call) || SocketAnswersAtOnce(call, fd, transfer);
  }
  return FileAnswersAtOnce(task, call, fd, transfer.reads) ||
         (is_socket && SocketFailsAtOnce(fd, 0, transfer.reads));
}

}  // namespace

bool SyscallTransfers::Receives(const TrappedCall& call) { return TransferOf(call).reads; }

void SyscallTransfers::Handle(Task& task, const TrappedCall& call) {
  const Transfer transfer = TransferOf(call);
  const short events = transfer.reads ? POLLIN : POLLOUT;
  const auto number = static_cast<int>(call.args[0]);
  RemoteDescriptor fd(task, number);
  if (draws_.Read(task, call, fd)) return;
  task.trap_continues = true;
  if (!fd.CanWait()) return;
  if (transfer.reads) fd.AcknowledgeAtOnce();
  // Threads that connect wait for room in the backlog.
  if (call.number == SYS_accept || call.number == SYS_accept4) {
    task.after_call = AfterCall::kBacklogs;
  }
  if (!transfer.reads) {
    shm::NoteSent(SlotOf(task).receipts);
    local_sockets_.ReachesBy(task, call);
    if (waker_.counts().for_objects() > 0 && fd.IsTerminal())
      task.after_call = AfterCall::kTerminals;
  } else if (fd.IsReady(events) && (transfer.flags & (MSG_PEEK | MSG_ERRQUEUE)) == 0) {
    const bool of_timer = timers_.Find(task, number).owner != nullptr;
    if (of_timer || !fd.IsEventFd()) activations_.ReceivedRaw(task, of_timer);
  }
  const bool is_ready =
      fd.IsReady(events) || (!transfer.reads && fd.HasRoomFor(BytesToSend(task, call)));
  if (call.number == SYS_connect) {
    outside_.ConnectsRaw(task, number, fd.fd());
  } else if (!transfer.reads && outside_.AsksRaw(task, fd.fd())) {
    descriptors_.BeginAllAgain(run_.table);
  }
  if (is_ready || fd.IsNonBlocking() || AnswersAtOnce(task, call, fd, transfer)) {
    waker_.HoldInCall(
        task, transfer.reads ? shm::NotificationKind::kRead : shm::NotificationKind::kWrite);
    return;
  }
  const std::int64_t timeout = fd.SocketTimeout(transfer.reads ? SO_RCVTIMEO : SO_SNDTIMEO);
  const shm::WaitFd waited{number, static_cast<std::uint32_t>(events)};
  std::vector<DescriptorWaits::Copy> copies;
  copies.push_back({waited, fd.Take()});
  awaited::Descriptors watched = descriptors_.Watch(task, std::move(copies));
  watched.keep = shm::KeepFiles::kForCall;
  watched.transfers = true;
  watched.takes = watched.fds.size() == 1;
  watched.events = waited.events;
  descriptors_.GoBehind(task, watched);
  waker_.Wait(task, {std::move(watched),
                     timeout == shm::kNeverNs ? VirtualTime::Never()
                                              : AtMostNever(task.reached, VirtualNs(timeout)),
                     true});
}

}  // namespace tcs
