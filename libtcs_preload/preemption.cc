#include "libtcs_preload/preemption.h"

#include <signal.h>
#include <ucontext.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/spinning/pauses.h"
#include "shm/clock_page.h"

// The code that the kernel has a handler return to: rt_sigreturn, which takes no arguments.
__asm__(
    ".text\n"
    ".type tcs_return_from_handler, @function\n"
    "tcs_return_from_handler:\n"
    "  mov $15, %eax\n"
    "  syscall\n"
    ".size tcs_return_from_handler, .-tcs_return_from_handler\n");
extern "C" __attribute__((visibility("hidden"))) void tcs_return_from_handler();

namespace tcs::preload {

namespace {

using Handler = void (*)(int, siginfo_t*, void*);

// The action of a signal, as the kernel has it.
struct Action {
  Handler handler;
  unsigned long flags;
  void (*restorer)();
  unsigned long mask;
};

constexpr unsigned long kHasRestorer = 0x04000000;  // SA_RESTORER
constexpr unsigned long kSetSize = 8;

Handler g_libcs = nullptr;  // the C library's handler of this signal, once it has one

bool IsForThisDispatch(const shm::ThreadSlot& slot, const siginfo_t& info) {
  const auto ended = reinterpret_cast<std::uintptr_t>(info.si_value.sival_ptr);
  return ended == shm::DispatchNumber(slot.clock.executed_adjust.load());
}

void StopHere(int signal, siginfo_t* info, void* context) {
  if (info->si_code != SI_QUEUE) {
    if (g_libcs != nullptr) g_libcs(signal, info, context);
    return;
  }
  if (OwnState().attaching) return;
  // The thread, or its process, was made past the shim and computes: the thread goes to the gate by
  // attaching.
  GuestThread* const attached = IfAttached();
  if (attached == nullptr) {
    if (!IsShutDown()) Current();
    return;
  }
  GuestThread& thread = *attached;
  if (IsShutDown()) return;
  const auto& interrupted = *static_cast<const ucontext_t*>(context);
  if (reinterpret_cast<std::uintptr_t>(info->si_value.sival_ptr) == shm::kAsksWhere) {
    return NoteWhetherInLoop(thread,
                             static_cast<std::uintptr_t>(interrupted.uc_mcontext.gregs[REG_RIP]));
  }
  if (!IsForThisDispatch(*thread.slot, *info)) return;
  if (IsAtGate(thread)) {
    // With levels a signal of the program's has brought the thread here, whose handler is to run
    // when the thread is dispatched. Without levels the handler ends the wait.
    if (g_header->is_unprivileged == 0) AwaitDispatch(thread);
    return;
  }
  const auto* blocked = reinterpret_cast<const unsigned long*>(&interrupted.uc_sigmask);
  Exchange(thread, Request{.kind = shm::NotificationKind::kPreempted, .blocked = blocked});
}

}  // namespace

void AllowPreemption() {
  if (OwnSignals() == 0) return;
  Action now{};
  RawSyscall(SYS_rt_sigaction, shm::kPreemptionSignal, 0, Arg(&now), kSetSize);
  if (now.handler != StopHere) {
    const bool is_libcs = (now.flags & SA_SIGINFO) != 0;
    if (is_libcs) g_libcs = now.handler;
    // No other handler runs on top of this one: the thread is not dispatched there.
    const Action ours{StopHere, SA_SIGINFO | SA_RESTART | SA_ONSTACK | kHasRestorer,
                      tcs_return_from_handler, ~0ul};
    RawSyscall(SYS_rt_sigaction, shm::kPreemptionSignal, Arg(&ours), 0, kSetSize);
  }
  const unsigned long own = OwnSignals();
  RawSyscall(SYS_rt_sigprocmask, SIG_UNBLOCK, Arg(&own), 0, kSetSize);
}

WithoutPreemption::WithoutPreemption() {
  static_assert(sizeof before_ == sizeof(Action));
  if (OwnSignals() == 0) return;
  const auto ignores = reinterpret_cast<Handler>(reinterpret_cast<std::uintptr_t>(SIG_IGN));
  const Action ignored{ignores, 0, nullptr, 0};
  RawSyscall(SYS_rt_sigaction, shm::kPreemptionSignal, Arg(&ignored), Arg(&before_), kSetSize);
}

// No program was executed.
WithoutPreemption::~WithoutPreemption() {
  if (OwnSignals() == 0) return;
  RawSyscall(SYS_rt_sigaction, shm::kPreemptionSignal, Arg(&before_), 0, kSetSize);
}

}  // namespace tcs::preload
