#include "coordinator/port/traps.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/seccomp.h>
#include <sys/ioctl.h>
#include <sys/uio.h>

namespace tcs {

std::optional<TrappedCall> ReceiveTrapped(int listener) {
  seccomp_notif notification{};
  if (ioctl(listener, SECCOMP_IOCTL_NOTIF_RECV, &notification) != 0) return std::nullopt;
  TrappedCall call;
  call.listener = listener;
  call.id = notification.id;
  call.tid = static_cast<pid_t>(notification.pid);
  call.number = notification.data.nr;
  for (int i = 0; i < 6; ++i) call.args[i] = notification.data.args[i];
  return call;
}

bool AnswerTrapped(int listener, std::uint64_t id, std::int64_t result) {
  seccomp_notif_resp response{};
  response.id = id;
  if (result < 0) {
    response.error = static_cast<std::int32_t>(result);
  } else {
    response.val = result;
  }
  return ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, &response) == 0;
}

namespace {

int AddFile(int listener, std::uint64_t id, int file, bool on_exec, unsigned flags) {
  seccomp_notif_addfd added{};
  added.id = id;
  added.flags = flags;
  added.srcfd = static_cast<std::uint32_t>(file);
  added.newfd_flags = on_exec ? 0 : O_CLOEXEC;
  return ioctl(listener, SECCOMP_IOCTL_NOTIF_ADDFD, &added);
}

}  // namespace

bool AnswerTrappedByFile(int listener, std::uint64_t id, int file, bool on_exec) {
  return AddFile(listener, id, file, on_exec, SECCOMP_ADDFD_FLAG_SEND) >= 0 ||
         AnswerTrapped(listener, id, -errno);
}

int PutFileInto(int listener, std::uint64_t id, int file, bool on_exec) {
  return AddFile(listener, id, file, on_exec, 0);
}

bool ContinueTrapped(int listener, std::uint64_t id) {
  seccomp_notif_resp response{};
  response.id = id;
  response.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
  return ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, &response) == 0;
}

bool HasAnswerToTake(int listener, std::uint64_t id) {
  return ioctl(listener, SECCOMP_IOCTL_NOTIF_ID_VALID, &id) == 0;
}

bool GiveDescriptor(const TrappedCall& call, int ours, int number) {
  seccomp_notif_addfd add{};
  add.id = call.id;
  add.flags = SECCOMP_ADDFD_FLAG_SETFD;
  add.srcfd = static_cast<std::uint32_t>(ours);
  add.newfd = static_cast<std::uint32_t>(number);
  add.newfd_flags = O_CLOEXEC;
  return ioctl(call.listener, SECCOMP_IOCTL_NOTIF_ADDFD, &add) == number;
}

bool ReadMemory(pid_t pid, std::uint64_t address, void* to, std::size_t size) {
  const iovec local{to, size}, remote{reinterpret_cast<void*>(address), size};
  return process_vm_readv(pid, &local, 1, &remote, 1, 0) == static_cast<ssize_t>(size);
}

bool ReadMemory(pid_t pid, const RemotePiece& first, const RemotePiece& second) {
  const iovec local[] = {{first.to, first.size}, {second.to, second.size}};
  const iovec remote[] = {{reinterpret_cast<void*>(first.address), first.size},
                          {reinterpret_cast<void*>(second.address), second.size}};
  return process_vm_readv(pid, local, 2, remote, 2, 0) ==
         static_cast<ssize_t>(first.size + second.size);
}

bool ReadMemory(pid_t pid, const std::vector<iovec>& from, void* to, std::size_t size) {
  const iovec local{to, size};
  return size == 0 || process_vm_readv(pid, &local, 1, from.data(), from.size(), 0) ==
                          static_cast<ssize_t>(size);
}

bool WriteMemory(pid_t pid, const std::vector<iovec>& to, const void* from, std::size_t size) {
  const iovec local{const_cast<void*>(from), size};
  return size == 0 ||
         process_vm_writev(pid, &local, 1, to.data(), to.size(), 0) == static_cast<ssize_t>(size);
}

bool WriteMemory(pid_t pid, std::uint64_t address, const void* from, std::size_t size) {
  const iovec local{const_cast<void*>(from), size}, remote{reinterpret_cast<void*>(address), size};
  return process_vm_writev(pid, &local, 1, &remote, 1, 0) == static_cast<ssize_t>(size);
}

// The kernel refuses a process without the right to look before it looks for the memory.
int WhyNoLooksInto(pid_t pid) {
  static const char there = 1;
  char found;
  const bool read = ReadMemory(pid, reinterpret_cast<std::uint64_t>(&there), &found, 1);
  return read || errno == EFAULT ? 0 : errno;
}

}  // namespace tcs
