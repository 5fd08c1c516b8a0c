#include "libtcs_preload/virtual_clock.h"

#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/receipts.h"

namespace tcs::preload {

namespace {

using shm::ClockPage;
using shm::ClockReading;
using shm::NotificationKind;

// A consistent reading from which stolen time has been taken out, if there may be much of it.
ClockReading ReadChecked(ClockPage& page) {
  for (;;) {
    const ClockReading r = shm::ReadClock(page);
    if (__builtin_expect(!shm::IsCheckDue(page, r), 1)) return r;
    timespec cpu;
    RawSyscall(SYS_clock_gettime, CLOCK_THREAD_CPUTIME_ID, Arg(&cpu));
    shm::RemoveStolen(page, r, ToNs(cpu));
  }
}

// A sleep inside the horizon is one addition. False where the sleep has to be asked for.
inline bool MoveOwnClock(ClockPage& page, ClockReading r, std::int64_t deadline_ns) {
  for (;; r = ReadChecked(page)) {
    const std::int64_t now = shm::ShownTime(page, r);
    if (now >= deadline_ns && r.time_ns >= deadline_ns) return true;
    if (deadline_ns > page.idle_until_ns) return false;
    std::uint64_t expected = r.waited_word;
    const std::int64_t waited = shm::AdjustValue(r.waited_word) + (deadline_ns - r.time_ns);
    if (page.waited_adjust.compare_exchange_strong(expected,
                                                   shm::PackAdjust(r.waited_word, waited))) {
      page.last_shown_ns.store(deadline_ns > now ? deadline_ns : now, std::memory_order_relaxed);
      return true;
    }
  }
}

}  // namespace

Now ReadNowSlowly(GuestThread& thread) {
  ClockPage& page = thread.slot->clock;
  for (;;) {
    const ClockReading r = ReadChecked(page);
    // A handler that has interrupted an exchange would end its wait by another exchange.
    const bool may_ask = thread.depth == 0 || (g_header->is_unprivileged != 0 && !IsAtGate(thread));
    const Now now = Show(page, r);
    if (now.shown_ns < r.horizon_ns || !may_ask || IsShutDown()) return now;
    Exchange(thread, Request{.kind = NotificationKind::kHorizon});
  }
}

std::int64_t ThreadCpuNs(GuestThread& thread) {
  NowNs(thread);  // a spin on the CPU clock, too, must reach its horizon
  // Time that was stolen since the last look is taken out later; time that has been shown stays.
  const std::int64_t now_ns = ReadChecked(thread.slot->clock).cpu_ns;
  if (now_ns > thread.cpu_shown_ns) thread.cpu_shown_ns = now_ns;
  return thread.cpu_shown_ns;
}

std::int64_t ProcessCpuNs(GuestThread& thread) {
  return ThreadCpuNs(thread) + thread.slot->clock.other_cpu_ns;
}

std::int64_t ChildrenCpuNs(const GuestThread& thread) { return thread.slot->clock.children_cpu_ns; }

namespace {

bool Sleep(GuestThread& thread, const ClockReading& now, std::int64_t deadline_ns, bool is_date) {
  if (IsShutDown()) {
    // The clock stands still; a program that sleeps until it is told to end must not spin.
    const timespec turn{0, 10'000'000};
    return RawSyscall(SYS_nanosleep, Arg(&turn), 0) == 0;
  }
  if (thread.depth == 0 && MoveOwnClock(thread.slot->clock, now, deadline_ns)) {
    NoteSlept(thread, now.time_ns, now.cpu_ns, deadline_ns);
    return true;
  }
  const Reply reply = Exchange(thread, Request{.kind = NotificationKind::kIdle,
                                               .deadline_ns = deadline_ns,
                                               .args = {0, 0, is_date ? 1 : 0},
                                               .interruptible = true});
  return reply.reason != shm::WakeReason::kSignal;
}

}  // namespace

bool SleepUntil(GuestThread& thread, std::int64_t deadline_ns) {
  return SleepUntil(thread, ReadChecked(thread.slot->clock), deadline_ns);
}

bool SleepUntil(GuestThread& thread, const ClockReading& now, std::int64_t deadline_ns) {
  return Sleep(thread, now, deadline_ns, false);
}

bool SleepUntilDate(GuestThread& thread, std::int64_t date_ns) {
  return Sleep(thread, ReadChecked(thread.slot->clock),
               AddSaturated(date_ns, -OffsetNs(Clock::kRealtime)), true);
}

std::int64_t DeadlineAfter(GuestThread& thread, std::int64_t timeout_ns) {
  return timeout_ns < 0 ? shm::kNeverNs : AddSaturated(NowNs(thread), timeout_ns);
}

namespace {

// The thread holds. False if a handler has run meanwhile, and the thread's time is another one now.
bool Hold(GuestThread& thread, NotificationKind for_what) {
  const std::uint32_t handlers = thread.handlers;
  Exchange(thread, Request{.kind = for_what});
  return thread.handlers == handlers || IsShutDown();
}

}  // namespace

void HoldForRead(GuestThread& thread) {
  std::int64_t now = NowNs(thread);
  ClockPage& page = thread.slot->clock;
  if (now <= page.read_safe_ns) return;
  if (g_header->sync == shm::Sync::kConsistent) {
    while (!Hold(thread, NotificationKind::kRead)) {
      now = NowNs(thread);
      if (now <= page.read_safe_ns) return;
    }
    if (now <= page.read_safe_ns || IsShutDown()) return;
  }
  // The data read now is older than the read by this much.
  const std::int64_t stale = now - page.read_safe_ns;
  if (stale > page.staleness_ns.load(std::memory_order_relaxed)) {
    page.staleness_ns.store(stale, std::memory_order_relaxed);
  }
}

bool BeginWrite(GuestThread& thread) {
  NoteSent(thread);
  const std::int64_t now = NowNs(thread);
  BeginChange(thread);
  return now <= thread.slot->clock.write_safe_ns || g_header->sync != shm::Sync::kConsistent;
}

void HoldForWrite(GuestThread& thread) {
  while (!BeginWrite(thread)) {
    if (Hold(thread, NotificationKind::kWrite)) return;
  }
}

}  // namespace tcs::preload
