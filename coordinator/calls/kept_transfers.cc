#include "coordinator/calls/kept_transfers.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/tasks/client_values.h"
#include "coordinator/tasks/remote_descriptor.h"

namespace tcs {

namespace {

constexpr std::size_t kMostBytes = 1 << 20;  // of a stream at a time, and of any message
constexpr std::size_t kMostControl = 1 << 16;

// As long as a NonBlocking lives, calls on the file do not wait.
class NonBlocking {
 public:
  explicit NonBlocking(int file) : file_(file), flags_(fcntl(file, F_GETFL)) {
    fcntl(file_, F_SETFL, flags_ | O_NONBLOCK);
  }
  ~NonBlocking() { fcntl(file_, F_SETFL, flags_); }
  NonBlocking(const NonBlocking&) = delete;
  NonBlocking& operator=(const NonBlocking&) = delete;

 private:
  const int file_, flags_;
};

// The buffers of a call, and for sockets what goes with them; addresses are the program's.
struct Message {
  std::vector<iovec> buffers;
  int flags = 0;
  std::uint64_t header = 0;  // of recvmsg and its kin; 0: none
  std::uint64_t name = 0, name_size_at = 0;
  msghdr given{};
  bool is_one_of_several = false;
};

bool ReadBuffers(const Task& task, std::uint64_t address, std::uint64_t count, Message& message) {
  if (count > IOV_MAX) return false;
  message.buffers.resize(count);
  return count == 0 || ReadMemory(task.process->pid, address, message.buffers.data(),
                                  count * sizeof message.buffers[0]);
}

bool ReadHeader(const Task& task, std::uint64_t address, int flags, Message& message) {
  message.header = address;
  message.flags = flags;
  return Read(task, address, &message.given) &&
         ReadBuffers(task, reinterpret_cast<std::uintptr_t>(message.given.msg_iov),
                     message.given.msg_iovlen, message);
}

std::optional<Message> MessageOf(const Task& task, const TrappedCall& call) {
  Message message;
  const auto flags = [&call](int at) { return static_cast<int>(call.args[at]); };
  bool is_sound = true;
  switch (call.number) {
    case SYS_readv:
    case SYS_writev:
      is_sound = ReadBuffers(task, call.args[1], call.args[2], message);
      break;
    case SYS_recvmsg:
    case SYS_sendmsg:
      is_sound = ReadHeader(task, call.args[1], flags(2), message);
      break;
    case SYS_recvmmsg:
    case SYS_sendmmsg:  // the first one
      message.is_one_of_several = true;
      is_sound = ReadHeader(task, call.args[1], flags(3), message);
      break;
    case SYS_recvfrom:
    case SYS_sendto:
      message.flags = flags(3);
      message.name = call.args[4];
      message.name_size_at = call.args[5];
      [[fallthrough]];
    default:
      message.buffers = {{reinterpret_cast<void*>(call.args[1]), call.args[2]}};
  }
  if (!is_sound) return std::nullopt;
  return message;
}

std::size_t BytesOf(const std::vector<iovec>& buffers) {
  std::size_t bytes = 0;
  for (const iovec& buffer : buffers) bytes += std::min(buffer.iov_len, std::size_t{INT_MAX});
  return bytes;
}

// Leaves out the first `bytes`.
void Skip(std::vector<iovec>& buffers, std::size_t bytes) {
  for (iovec& buffer : buffers) {
    const std::size_t part = std::min(bytes, buffer.iov_len);
    buffer.iov_base = static_cast<char*>(buffer.iov_base) + part;
    buffer.iov_len -= part;
    bytes -= part;
  }
}

bool IsSocket(int file) {
  int type = 0;
  socklen_t size = sizeof type;
  return getsockopt(file, SOL_SOCKET, SO_TYPE, &type, &size) == 0;
}

// The program gets each descriptor that has come with a message, under a number of its own.
void HandOver(const Task& task, msghdr& received, bool on_exec) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&received); part != nullptr;
       part = CMSG_NXTHDR(&received, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int number = -1;
      memcpy(&number, CMSG_DATA(part) + i * sizeof number, sizeof number);
      const UniqueFd file(number);
      number = PutFileInto(task.trap_listener, task.trap_id, file.get(), on_exec);
      memcpy(CMSG_DATA(part) + i * sizeof number, &number, sizeof number);
    }
  }
}

// The other way: the message takes copies of the program's own descriptors along, which live as
// long as `copies`.
bool TakeAlong(const Task& task, msghdr& sent, std::vector<UniqueFd>& copies) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&sent); part != nullptr; part = CMSG_NXTHDR(&sent, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int number = -1;
      memcpy(&number, CMSG_DATA(part) + i * sizeof number, sizeof number);
      copies.push_back(CopyOfDescriptor(*task.process, number));
      if (!copies.back()) return false;
      number = copies.back().get();
      memcpy(CMSG_DATA(part) + i * sizeof number, &number, sizeof number);
    }
  }
  return true;
}

bool WriteName(const Task& task, const Message& message, const msghdr& received) {
  if (message.header != 0 || message.name == 0) return true;
  socklen_t room = 0;
  if (!Read(task, message.name_size_at, &room)) return false;
  return WriteMemory(task.process->pid, message.name, received.msg_name,
                     std::min(room, received.msg_namelen)) &&
         Write(task, message.name_size_at, received.msg_namelen);
}

bool WriteHeader(const Task& task, const Message& message, const msghdr& received, long bytes) {
  if (message.header == 0) return true;
  msghdr header = message.given;
  const pid_t pid = task.process->pid;
  const auto address = [](const void* pointer) {
    return reinterpret_cast<std::uintptr_t>(pointer);
  };
  const socklen_t room = std::exchange(header.msg_namelen, received.msg_namelen);
  const bool has_name = header.msg_name != nullptr;
  header.msg_controllen = received.msg_controllen;
  header.msg_flags = received.msg_flags & ~MSG_CMSG_CLOEXEC;
  return (!has_name || WriteMemory(pid, address(header.msg_name), received.msg_name,
                                   std::min(room, received.msg_namelen))) &&
         WriteMemory(pid, address(header.msg_control), received.msg_control,
                     received.msg_controllen) &&
         Write(task, message.header, header) &&
         (!message.is_one_of_several ||
          Write(task, message.header + offsetof(mmsghdr, msg_len), static_cast<unsigned>(bytes)));
}

std::int64_t Receive(const Task& task, int file, const Message& message) {
  std::vector<char> bytes(std::min(BytesOf(message.buffers), kMostBytes));
  sockaddr_storage name{};
  std::vector<char> control(std::min(message.given.msg_controllen, kMostControl));
  iovec all{bytes.data(), bytes.size()};
  msghdr received{};
  received.msg_name = &name;
  received.msg_namelen = sizeof name;
  received.msg_iov = &all;
  received.msg_iovlen = 1;
  received.msg_control = control.data();
  received.msg_controllen = control.size();
  long got = 0;
  {
    const NonBlocking by_flag(file);
    got = IsSocket(file) ? recvmsg(file, &received, message.flags | MSG_DONTWAIT | MSG_CMSG_CLOEXEC)
                         : readv(file, &all, 1);
  }
  if (got < 0) return -errno;
  HandOver(task, received, (message.flags & MSG_CMSG_CLOEXEC) == 0);
  const std::size_t stored = std::min(static_cast<std::size_t>(got), bytes.size());
  if (!WriteMemory(task.process->pid, message.buffers, bytes.data(), stored) ||
      !WriteName(task, message, received) || !WriteHeader(task, message, received, got)) {
    return -EFAULT;
  }
  return message.is_one_of_several ? 1 : got;
}

std::int64_t Send(Task& task, int file, Message message) {
  std::int64_t& done = task.kept->done;
  Skip(message.buffers, static_cast<std::size_t>(done));
  std::vector<char> bytes(std::min(BytesOf(message.buffers), kMostBytes));
  std::vector<char> name(sizeof(sockaddr_storage));
  std::vector<char> control(std::min(message.given.msg_controllen, kMostControl));
  const pid_t pid = task.process->pid;
  const bool has_header = message.header != 0;
  const auto name_at =
      has_header ? reinterpret_cast<std::uintptr_t>(message.given.msg_name) : message.name;
  name.resize(name_at == 0 ? 0
                           : std::min<std::size_t>(
                                 has_header ? message.given.msg_namelen : message.name_size_at,
                                 sizeof(sockaddr_storage)));
  if (!ReadMemory(pid, message.buffers, bytes.data(), bytes.size()) ||
      !ReadMemory(pid, name_at, name.data(), name.size()) ||
      !ReadMemory(pid, reinterpret_cast<std::uintptr_t>(message.given.msg_control), control.data(),
                  control.size())) {
    return done > 0 ? done : -EFAULT;
  }
  iovec all{bytes.data(), bytes.size()};
  msghdr sent{};
  sent.msg_name = name.empty() ? nullptr : name.data();
  sent.msg_namelen = static_cast<socklen_t>(name.size());
  sent.msg_iov = &all;
  sent.msg_iovlen = 1;
  sent.msg_control = done > 0 ? nullptr : control.data();
  sent.msg_controllen = done > 0 ? 0 : control.size();
  std::vector<UniqueFd> copies;
  if (!TakeAlong(task, sent, copies)) return -EBADF;
  long n = 0;
  {
    const NonBlocking by_flag(file);
    n = IsSocket(file) ? sendmsg(file, &sent, message.flags | MSG_DONTWAIT | MSG_NOSIGNAL)
                       : writev(file, &all, 1);
  }
  const int error = errno;
  if (n < 0) {
    if (error == EPIPE && (message.flags & MSG_NOSIGNAL) == 0) {
      syscall(SYS_tgkill, pid, task.tid, SIGPIPE);
    }
    return error == EAGAIN || done == 0 ? -error : done;
  }
  done += n;
  if (message.is_one_of_several) {
    Write(task, message.header + offsetof(mmsghdr, msg_len), static_cast<unsigned>(n));
    return 1;
  }
  return static_cast<std::size_t>(n) < BytesOf(message.buffers) ? -EAGAIN : done;
}

std::int64_t Accept(Task& task, int file, const TrappedCall& call) {
  const int flags = call.number == SYS_accept4 ? static_cast<int>(call.args[3]) : 0;
  sockaddr_storage name{};
  socklen_t size = sizeof name, room = 0;
  {
    const NonBlocking by_flag(file);
    task.trap_file.Reset(
        accept4(file, reinterpret_cast<sockaddr*>(&name), &size, flags | SOCK_CLOEXEC));
  }
  if (!task.trap_file) return -errno;
  task.trap_file_on_exec = (flags & SOCK_CLOEXEC) == 0;
  if (call.args[1] == 0) return 0;
  if (!Read(task, call.args[2], &room) ||
      !WriteMemory(task.process->pid, call.args[1], &name, std::min(room, size)) ||
      !Write(task, call.args[2], size)) {
    task.trap_file.Reset();
    return -EFAULT;
  }
  return 0;
}

}  // namespace

std::int64_t KeptTransfers::CarryOut(Task& task, const TrappedCall& call) {
  const int file = task.kept->files.front().get();
  if (call.number == SYS_accept || call.number == SYS_accept4) return Accept(task, file, call);
  const std::optional<Message> message = MessageOf(task, call);
  if (!message.has_value()) return -EFAULT;
  switch (call.number) {
    case SYS_read:
    case SYS_readv:
    case SYS_recvfrom:
    case SYS_recvmsg:
    case SYS_recvmmsg:
      return Receive(task, file, *message);
    default:
      return Send(task, file, *message);
  }
}

}  // namespace tcs
