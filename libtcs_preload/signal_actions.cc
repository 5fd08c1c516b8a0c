#include "libtcs_preload/signal_actions.h"

#include <errno.h>
#include <signal.h>

#include <atomic>
#include <cstdint>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/interrupted_call.h"
#include "libtcs_preload/own_work.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"

namespace tcs::preload {

namespace {

using Handler = void (*)(int, siginfo_t*, void*);

constexpr int kSignals = 65;
constexpr int kOurFlags = SA_SIGINFO | SA_RESTART;  // of every handler, in the kernel

// A handler, and those of kOurFlags that the program has given it. Both are in one value, so that
// it can change while signals come.
class Wanted {
 public:
  Wanted() = default;
  explicit Wanted(const struct sigaction& action)
      : value_(reinterpret_cast<std::uintptr_t>(action.sa_sigaction) |
               ((action.sa_flags & SA_RESTART) != 0 ? kRestarts : 0) |
               ((action.sa_flags & SA_SIGINFO) != 0 ? kHasInfo : 0)) {}

  Handler handler() const { return reinterpret_cast<Handler>(value_ & ~(kRestarts | kHasInfo)); }
  bool restarts() const { return (value_ & kRestarts) != 0; }
  int flags() const {
    return (restarts() ? SA_RESTART : 0) | ((value_ & kHasInfo) != 0 ? SA_SIGINFO : 0);
  }

 private:
  // No address of a program is that high.
  static constexpr std::uintptr_t kRestarts = std::uintptr_t{1} << 63, kHasInfo = kRestarts >> 1;
  std::uintptr_t value_ = 0;
};

std::atomic<Wanted> g_wanted[kSignals];
static_assert(std::atomic<Wanted>::is_always_lock_free);
std::atomic<std::uint64_t> g_interrupting;  // siginterrupt; bit 0 is signal 1

// A call that was handed over, and of which the coordinator has not said that it waits, has only
// not been answered yet.
bool HasWaited() {
  const GuestThread* t = IfAttached();
  if (t == nullptr || t->attaching || IsShutDown()) return true;
  return t->slot->waits_in_call.exchange(0) != 0;
}

// The function that the kernel runs for every handler of the program's.
void OnSignal(int signal, siginfo_t* info, void* context) {
  const Wanted wanted = g_wanted[signal].load();
  GuestThread& thread = OwnState();
  NoteHandler(thread);
  InterruptedCall call(*static_cast<ucontext_t*>(context));
  if (call.IsMadeAgain()) {
    const EndBySignal end = call.HowItEnds();
    const bool may_fail =
        end == EndBySignal::kAlways || (end == EndBySignal::kUnlessRestart && !wanted.restarts());
    if (may_fail && (!call.IsHandedOver() || HasWaited())) call.FailWithEintr();
  }
  if (thread.depth > 0) AwaitTurnOfHandler(thread);
  const PausedOwnWork paused(thread);
  wanted.handler()(signal, info, context);
}

bool IsHandler(const struct sigaction& action) {
  return action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN;
}

int SetAction(int signal, const struct sigaction* action, struct sigaction* before) {
  const auto real = TCS_REAL(sigaction);
  if (signal <= 0 || signal >= kSignals || g_process->mode == ProcessState::kPassThrough) {
    return real(signal, action, before);
  }
  std::atomic<Wanted>& wanted = g_wanted[signal];
  const Wanted had = wanted.load();
  struct sigaction old {};
  int result = 0;
  if (action == nullptr || !IsHandler(*action)) {
    result = real(signal, action, &old);
  } else {
    struct sigaction ours = *action;
    ours.sa_sigaction = OnSignal;
    ours.sa_flags |= kOurFlags;
    wanted.store(Wanted(*action));
    result = real(signal, &ours, &old);
    if (result != 0) wanted.store(had);
  }
  if (result == 0 && before != nullptr) {
    if (old.sa_sigaction == OnSignal) {
      old.sa_sigaction = had.handler();
      old.sa_flags = (old.sa_flags & ~kOurFlags) | had.flags();
    }
    *before = old;
  }
  return result;
}

// As the C library's functions that know nothing but a handler.
sighandler_t SetHandler(int signal, sighandler_t handler, int flags, bool blocks) {
  if (handler == SIG_ERR) {
    errno = EINVAL;
    return SIG_ERR;
  }
  struct sigaction action {
  }, before{};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  if (blocks && sigaddset(&action.sa_mask, signal) != 0) return SIG_ERR;
  return SetAction(signal, &action, &before) == 0 ? before.sa_handler : SIG_ERR;
}

std::uint64_t BitOf(int signal) { return std::uint64_t{1} << (signal - 1); }

bool Interrupts(int signal) {
  return signal > 0 && signal < kSignals && (g_interrupting.load() & BitOf(signal)) != 0;
}

}  // namespace

bool RestartsAfterSignal() {
  struct KernelAction {
    std::uintptr_t handler;
    unsigned long flags;
    void (*restorer)();
    unsigned long mask;
  };
  for (int signal = 1; signal < kSignals; ++signal) {
    KernelAction action{};
    if (RawSyscall(SYS_rt_sigaction, signal, 0, Arg(&action), sizeof action.mask) != 0) continue;
    if (action.handler == reinterpret_cast<std::uintptr_t>(SIG_DFL) ||
        action.handler == reinterpret_cast<std::uintptr_t>(SIG_IGN)) {
      continue;
    }
    const bool is_ours = action.handler == reinterpret_cast<std::uintptr_t>(OnSignal);
    const bool restarts =
        is_ours ? g_wanted[signal].load().restarts() : (action.flags & SA_RESTART) != 0;
    if (!restarts) return false;
  }
  return true;
}

}  // namespace tcs::preload

using namespace tcs::preload;

TCS_EXPORT int sigaction(int signal, const struct sigaction* action,
                         struct sigaction* before) noexcept {
  return SetAction(signal, action, before);
}

TCS_EXPORT sighandler_t signal(int signal, sighandler_t handler) noexcept {
  return SetHandler(signal, handler, Interrupts(signal) ? 0 : SA_RESTART, true);
}

TCS_EXPORT sighandler_t sysv_signal(int signal, sighandler_t handler) noexcept {
  return SetHandler(signal, handler, SA_RESETHAND | SA_NODEFER, false);
}

TCS_EXPORT sighandler_t sigset(int signal, sighandler_t disposition) noexcept {
  sigset_t own, before;
  sigemptyset(&own);
  if (sigaddset(&own, signal) != 0) return SIG_ERR;
  if (disposition == SIG_HOLD) {
    struct sigaction now {};
    if (sigprocmask(SIG_BLOCK, &own, &before) != 0) return SIG_ERR;
    if (sigismember(&before, signal) != 0) return SIG_HOLD;
    return SetAction(signal, nullptr, &now) == 0 ? now.sa_handler : SIG_ERR;
  }
  const sighandler_t had = SetHandler(signal, disposition, 0, false);
  if (had == SIG_ERR || sigprocmask(SIG_UNBLOCK, &own, &before) != 0) return SIG_ERR;
  return sigismember(&before, signal) != 0 ? SIG_HOLD : had;
}

TCS_EXPORT int siginterrupt(int signal, int flag) noexcept {
  struct sigaction action {};
  if (SetAction(signal, nullptr, &action) != 0) return -1;
  if (flag != 0) {
    g_interrupting.fetch_or(BitOf(signal));
    action.sa_flags &= ~SA_RESTART;
  } else {
    g_interrupting.fetch_and(~BitOf(signal));
    action.sa_flags |= SA_RESTART;
  }
  return SetAction(signal, &action, nullptr);
}
