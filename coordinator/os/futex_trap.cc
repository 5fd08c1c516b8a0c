#include "coordinator/os/futex_trap.h"

#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/futex.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "shm/layout.h"

namespace tcs {

namespace {

constexpr std::uint32_t Low(int arg) {
  return static_cast<std::uint32_t>(offsetof(seccomp_data, args) +
                                    sizeof(std::uint64_t) * static_cast<unsigned>(arg));
}

}  // namespace

int InstallFutexTrap() {
  constexpr std::uint32_t kLoad = BPF_LD | BPF_W | BPF_ABS, kEqual = BPF_JMP | BPF_JEQ | BPF_K,
                          kReturn = BPF_RET | BPF_K;
  const sock_filter program[] = {
      BPF_STMT(kLoad, offsetof(seccomp_data, arch)),
      BPF_JUMP(kEqual, AUDIT_ARCH_X86_64, 0, 6),
      BPF_STMT(kLoad, offsetof(seccomp_data, nr)),
      BPF_JUMP(kEqual, SYS_futex, 0, 4),
      // The shim's own waits at its gate carry a mark where FUTEX_WAIT ignores its argument.
      BPF_STMT(kLoad, Low(1)),
      BPF_JUMP(kEqual, FUTEX_WAIT, 0, 3),
      BPF_STMT(kLoad, Low(5)),
      BPF_JUMP(kEqual, shm::kGateFutexMark, 0, 1),
      BPF_STMT(kReturn, SECCOMP_RET_ALLOW),
      BPF_STMT(kReturn, SECCOMP_RET_USER_NOTIF),
  };
  const sock_fprog filter{sizeof program / sizeof program[0], const_cast<sock_filter*>(program)};
  auto install = [&filter] {
    return static_cast<int>(
        syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER,
                SECCOMP_FILTER_FLAG_NEW_LISTENER | SECCOMP_FILTER_FLAG_SPEC_ALLOW, &filter));
  };
  const int listener = install();
  if (listener >= 0 || errno != EACCES) return listener;
  // Without rights over others a filter must not outlive a set-uid exec.
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  return install();
}

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

bool ContinueTrapped(int listener, std::uint64_t id) {
  seccomp_notif_resp response{};
  response.id = id;
  response.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
  return ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, &response) == 0;
}

FutexKey KeyOf(pid_t pid, std::uint64_t address, bool is_private) {
  if (!is_private) {
    std::ifstream maps("/proc/" + std::to_string(pid) + "/maps");
    for (std::string line; std::getline(maps, line);) {
      unsigned long long first = 0, last = 0, offset = 0, inode = 0;
      unsigned major = 0, minor = 0;
      char rights[5] = "";
      if (sscanf(line.c_str(), "%llx-%llx %4s %llx %x:%x %llu", &first, &last, rights, &offset,
                 &major, &minor, &inode) != 7 ||
          address < first || address >= last) {
        continue;
      }
      if (rights[3] != 's') break;
      return {0, (std::uint64_t{major} << 20 | minor) << 40 ^ inode, address - first + offset};
    }
  }
  return {pid, 0, address};
}

bool ReadMemory(pid_t pid, std::uint64_t address, void* to, std::size_t size) {
  const iovec local{to, size}, remote{reinterpret_cast<void*>(address), size};
  return process_vm_readv(pid, &local, 1, &remote, 1, 0) == static_cast<ssize_t>(size);
}

bool WriteMemory(pid_t pid, std::uint64_t address, const void* from, std::size_t size) {
  const iovec local{const_cast<void*>(from), size}, remote{reinterpret_cast<void*>(address), size};
  return process_vm_writev(pid, &local, 1, &remote, 1, 0) == static_cast<ssize_t>(size);
}

}  // namespace tcs
