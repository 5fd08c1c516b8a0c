#include "tests/simulate/actions.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/virtual_clock.h"
#include "libtcs_preload/without_handlers.h"
#include "shm/time_values.h"
#include "tests/simulate/kernel.h"

namespace tcs::simulate {

// As libtcs_preload/guest.cc and attach.cc do, but for the connection: its place is there already.
void Attach(const preload::GuestThread& guest) {
  const preload::WithoutHandlers none;
  preload::t_thread = guest;
  preload::t_thread.attaching = true;
  guest.slot->blocked_signals = none.before();
  preload::AllowPreemption();
  preload::AwaitFirstDispatch(preload::t_thread);
  preload::t_thread.attaching = false;
}

void Compute(std::int64_t ns) { Kernel::This().Compute(ns, true); }

std::int64_t ReadClock() {
  preload::GuestThread* const guest = preload::Enter(preload::Concern::kNobody);
  return preload::NowNs(*guest);
}

bool SleepUntil(std::int64_t at_ns) {
  preload::Entered guest;
  return preload::SleepUntil(*guest.thread(), at_ns);
}

long Futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value) {
  return preload::RawSyscall(SYS_futex, preload::Arg(&word), operation | FUTEX_PRIVATE_FLAG, value,
                             0, 0, preload::kTrapped);
}

int CreateTimer(int signal) {
  sigevent event{};
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = signal;
  event._sigev_un._tid = preload::t_thread.tid;
  int timer = -1;
  preload::RawSyscall(SYS_timer_create, CLOCK_MONOTONIC, preload::Arg(&event), preload::Arg(&timer),
                      0, 0, preload::kTrapped);
  return timer;
}

void SetTimer(int timer, std::int64_t after_ns, std::int64_t interval_ns) {
  const itimerspec setting{shm::ToTimespec(interval_ns), shm::ToTimespec(after_ns)};
  preload::RawSyscall(SYS_timer_settime, timer, 0, preload::Arg(&setting), 0, 0, preload::kTrapped);
}

int OverrunsOf(int timer) {
  return static_cast<int>(
      preload::RawSyscall(SYS_timer_getoverrun, timer, 0, 0, 0, 0, preload::kTrapped));
}

void HandleBy(int signal, void (*handler)(int, siginfo_t*, void*), int flags) {
  struct sigaction action {};
  action.sa_sigaction = handler;
  action.sa_flags = SA_SIGINFO | flags;
  Simulated_sigaction(signal, &action, nullptr);
}

}  // namespace tcs::simulate
