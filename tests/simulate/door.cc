// The shim's way into the kernel, where that is the simulated one: what the sources of the shim
// that are built for it (TCS_SIMULATED_HOST) find in the place of the processor's instructions and
// of the parts of the shim that are not here.
#include <errno.h>
#include <linux/futex.h>
#include <signal.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>

#include <atomic>
#include <cstdint>

#include "libtcs_preload/descriptor_broker.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/spinning/pauses.h"
#include "libtcs_preload/timer_fds.h"
#include "shm/check.h"
#include "shm/time_values.h"
#include "shm/tsc.h"
#include "tests/simulate/kernel.h"

namespace tcs::shm {

std::uint64_t ReadTsc() {
  constexpr std::int64_t kTakesNs = 12;
  simulate::Kernel& kernel = simulate::Kernel::This();
  kernel.ComputeInShim(kTakesNs);
  return kernel.tsc();
}

}  // namespace tcs::shm

namespace tcs::preload {

namespace {

using simulate::Kernel;
using simulate::SimThread;

// What a system call takes, and what a wait takes besides.
constexpr std::int64_t kCallNs = 150, kWaitNs = 900;

template <class T>
T& At(long address) {
  return *reinterpret_cast<T*>(address);
}

long ChangeMask(SimThread& thread, long how, long set, long before) {
  if (before != 0) At<std::uint64_t>(before) = thread.blocked_signals;
  if (set == 0) return 0;
  const std::uint64_t signals = At<const std::uint64_t>(set);
  const std::uint64_t blocked = thread.blocked_signals;
  Kernel::This().SetBlocked(how == SIG_BLOCK     ? blocked | signals
                            : how == SIG_UNBLOCK ? blocked & ~signals
                                                 : signals);
  return 0;
}

long ReadCpuClock(const SimThread& thread, long to) {
  At<timespec>(to) = shm::ToTimespec(thread.cpu_ns);
  return 0;
}

}  // namespace

ProcessState* g_process = nullptr;
__thread GuestThread t_thread __attribute__((tls_model("initial-exec")));
const shm::RunMemory* g_run = nullptr;
const shm::RunHeader* g_header = nullptr;
int g_notify_fd = -1;
int g_broker_fd = -1;

long RawSyscall(long number, long a, long b, long c, long d, long e, long f) {
  Kernel& kernel = Kernel::This();
  kernel.ComputeInShim(kCallNs);
  SimThread& thread = *kernel.running();
  kernel.Note(thread, "makes the system call", number);
  if (f != static_cast<long>(shm::kOwnCallMark)) return kernel.Trap(number, {a, b, c, d, e, f});
  switch (number) {
    case SYS_clock_gettime:
      TCS_CHECK(a == CLOCK_THREAD_CPUTIME_ID);
      return ReadCpuClock(thread, b);
    case SYS_write:
      kernel.Note(thread, "notifies, of kind", static_cast<int>(t_thread.slot->note.kind));
      kernel.descriptors().Write(static_cast<int>(a), reinterpret_cast<const void*>(b),
                                 static_cast<std::size_t>(c));
      kernel.Notified();
      return c;
    case SYS_futex:
      TCS_CHECK(b == FUTEX_WAIT && d != 0);
      kernel.ComputeInShim(kWaitNs);
      return kernel.WaitAt(At<const std::atomic<std::uint32_t>>(a), static_cast<std::uint32_t>(c),
                           shm::ToNs(At<const timespec>(d)));
    case SYS_rt_sigprocmask:
      return ChangeMask(thread, a, b, c);
    case SYS_rt_sigaction:
      if (c != 0) {
        memset(reinterpret_cast<void*>(c), 0, 4 * sizeof(long));
        At<unsigned long>(c) = kernel.HandlerOf(static_cast<int>(a));
      }
      if (b != 0) kernel.SetHandler(static_cast<int>(a), At<const unsigned long>(b));
      return 0;
    case SYS_getpid:
      return thread.process.pid;
    case SYS_tgkill:
      kernel.Send(*kernel.Find(static_cast<pid_t>(b)), static_cast<int>(c));
      kernel.Returns();
      return 0;
    case SYS_kill:
      kernel.SendToProcess(kernel.Find(static_cast<pid_t>(a))->process, static_cast<int>(b));
      kernel.Returns();
      return 0;
    case SYS_ppoll:
      return 0;
    default:
      TCS_CHECK(!"a system call that the simulated kernel does not know");
      return -ENOSYS;
  }
}

void DieWithoutCoordinator(const char*) {
  TCS_CHECK(!"a program ends for its coordinator is gone");
}

// The C library's sigaction; the shim calls no other function of that library's here. Both have the
// handler first.
void* SimulatedReal(const char* name) {
  TCS_CHECK(strcmp(name, "sigaction") == 0);
  static const auto set = [](int signal, const struct sigaction* action, struct sigaction* before) {
    Kernel& kernel = Kernel::This();
    if (before != nullptr) {
      *before = {};
      before->sa_sigaction =
          reinterpret_cast<void (*)(int, siginfo_t*, void*)>(kernel.HandlerOf(signal));
    }
    if (action != nullptr)
      kernel.SetHandler(signal, reinterpret_cast<unsigned long>(action->sa_sigaction));
    return 0;
  };
  int (*const function)(int, const struct sigaction*, struct sigaction*) = set;
  return reinterpret_cast<void*>(function);
}

// Parts of the shim that a simulated program has no use for.
GuestThread* CurrentSlow() { return nullptr; }
GuestThread& StateInSharedStorage() { return t_thread; }
void MakeBroker() {}
void NoteWhetherInLoop(GuestThread&, std::uintptr_t) {}
bool IsTimerFd(int) { return false; }

}  // namespace tcs::preload
