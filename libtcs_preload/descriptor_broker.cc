#include "libtcs_preload/descriptor_broker.h"

#include <errno.h>
#include <linux/futex.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>

#include "libtcs_preload/raw_syscall.h"
#include "shm/attach_protocol.h"

namespace tcs::preload {

namespace {

constexpr std::size_t kSetSize = 8;  // the kernel's sigset_t
constexpr std::size_t kStackSize = 8192;
// Of the two processes that are made; at their ends they have no stack any more.
alignas(16) char g_parents_stack[kStackSize], g_brokers_stack[kStackSize];

enum BrokerState : std::uint32_t {
  kNotYet = 0,
  kIsThere = 1,
  kIsDeaf = 2,  // the program has closed the connection by a raw call: there can be none any more
};

// As clone: the child begins in `run`, which does not return, on that stack. The child's number is
// written to `tid` before it begins, and 0 when it has ended; null: neither.
long Clone(long flags, char* stack, void (*run)(), std::atomic<int>* tid) {
  if (tid != nullptr) flags |= CLONE_PARENT_SETTID | CLONE_CHILD_CLEARTID;
  long result;
  register long r10 __asm__("r10") = Arg(tid);
  register long r8 __asm__("r8") = 0;
  register long r9 __asm__("r9") = static_cast<long>(shm::kOwnCallMark);
  __asm__ volatile(
      "syscall\n\t"
      "xor %%r9d, %%r9d\n\t"
      "test %%rax, %%rax\n\t"
      "jnz 1f\n\t"
      "xor %%ebp, %%ebp\n\t"
      "call *%[run]\n\t"
      "ud2\n"
      "1:"
      : "=a"(result), "+r"(r9)
      : "a"(SYS_clone), "D"(flags), "S"(stack + kStackSize), "d"(Arg(tid)), "r"(r10),
        "r"(r8), [run] "b"(run)
      : "rcx", "r11", "memory", "cc");
  return result;
}

// A tracer is not told of these processes: it would take them for the program's.
constexpr long kShares = CLONE_VM | CLONE_FILES | CLONE_UNTRACED;

[[noreturn]] void End(long status) {
  for (;;) RawSyscall(SYS_exit, status);
}

// False if nobody is there any more to get the answer.
bool Answer(shm::BrokerAnswer answer, int fd) {
  iovec iov{&answer, sizeof answer};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof fd)] = {};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  if (fd >= 0) {
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof fd);
    *reinterpret_cast<int*>(CMSG_DATA(header)) = fd;
  }
  const long sent = RawSyscall(SYS_sendmsg, g_broker_fd, Arg(&message), MSG_NOSIGNAL);
  if (sent == static_cast<long>(sizeof answer)) return true;
  return fd >= 0 && Answer({static_cast<std::int32_t>(-sent), answer.serial}, -1);
}

[[noreturn]] void HandOver() {
  // Signals to the program's group, and to those of its terminal, are not for the broker.
  RawSyscall(SYS_setsid);
  RawSyscall(SYS_prctl, PR_SET_NAME, Arg("tcs-broker"));
  RawSyscall(SYS_chdir, Arg("/"));
  const bool is_heard = Answer({0, 0}, -1);
  g_process->broker_state.store(is_heard ? kIsThere : kIsDeaf);
  while (is_heard) {
    shm::BrokerRequest request{};
    const long n = RawSyscall(SYS_read, g_broker_fd, Arg(&request), sizeof request);
    if (n != static_cast<long>(sizeof request)) break;
    const bool answered = request.number < 0 ? Answer({EBADF, request.serial}, -1)
                                             : Answer({0, request.serial}, request.number);
    if (!answered) break;
  }
  End(0);
}

// The end of this process makes the broker an orphan. The process waits until the broker has told
// the coordinator who it is: meanwhile the thread that makes both stands in vfork.
[[noreturn]] void MakeOrphan() {
  constexpr timespec kTurn{0, 200'000};
  const std::atomic<std::uint32_t>& state = g_process->broker_state;
  const long broker = Clone(kShares, g_brokers_stack, HandOver, &g_process->broker);
  while (broker > 0 && state.load() == kNotYet && g_process->broker.load() != 0) {
    RawSyscall(SYS_futex, Arg(&state), FUTEX_WAIT, kNotYet, Arg(&kTurn));
  }
  End(broker > 0 ? 0 : 1);
}

// The wait here does not sleep: a dispatched thread that sleeps in a call which nobody knows is
// taken to be held by the kernel, and time would go on without it.

// Reaps a child that is about to end, or has ended.
int Reap(long child) {
  int status = 1;
  while (RawSyscall(SYS_wait4, child, Arg(&status), WNOHANG | __WALL) == 0) {
    RawSyscall(SYS_sched_yield);
  }
  return status;
}

}  // namespace

void MakeBroker() {
  if (g_broker_fd < 0 || g_process->broker_state.load() == kIsDeaf) return;
  if (g_process->makes_broker.exchange(1) != 0) return;
  // Both processes have this thread's mask.
  const unsigned long all = ~0ul;
  unsigned long before = 0;
  RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&all), Arg(&before), kSetSize);
  g_process->broker_state.store(kNotYet);
  const long parent = Clone(kShares | CLONE_VFORK, g_parents_stack, MakeOrphan, nullptr);
  if (parent < 0 || Reap(parent) != 0) {
    DieWithoutCoordinator(
        "no process can be made that hands it the program's descriptors (too many "
        "processes?)");
  }
  RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&before), 0, kSetSize);
  g_process->makes_broker.store(0);
}

}  // namespace tcs::preload
