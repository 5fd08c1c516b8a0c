#include "libtcs_preload/exchange.h"

#include <errno.h>
#include <linux/futex.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <time.h>

#include <algorithm>

#include "libtcs_preload/own_work.h"
#include "libtcs_preload/preemption.h"
#include "libtcs_preload/raw_syscall.h"
#include "shm/attach_protocol.h"
#include "shm/clock_page.h"
#include "shm/time_values.h"

namespace tcs::preload {

namespace {

using shm::NotificationKind;
using shm::Saying;
using shm::WakeReason;

// The gate is waited for in turns of this length, to notice a coordinator that was killed. With a
// timeout the kernel also never restarts the wait behind our back after a signal handler.
constexpr timespec kGateTurn{1, 0};
constexpr std::int64_t kMostGateNs = 10'000;
// More than a short system call takes, or one of its two ways.
constexpr std::int64_t kMostCallNs = 1'000;
constexpr std::size_t kSetSize = 8;  // the kernel's sigset_t; the C library's begins with it

// True where the thread's own CPU clock alone tells what the thread computes: other tasks have the
// processor as the thread has.
bool OnlyCpuClockTells(const shm::ClockPage& page) {
  return g_header->is_unprivileged != 0 && page.ns_per_tick_q32 != 0;
}

// Nothing stops the thread in the instant in which it notifies, and no coordinator sleeps until
// then.
bool RunsBeside(const shm::ThreadSlot& slot) {
  return slot.saying.load(std::memory_order_acquire) == Saying::kRuns;
}

// The time that the thread's clock has counted since `tsc`.
std::int64_t NsSince(const shm::ClockPage& page, std::uint64_t tsc) {
  return shm::MulQ32(static_cast<std::int64_t>(shm::ReadTsc() - tsc), page.ns_per_tick_q32);
}

// The thread's own CPU clock, and how far that reading was from either end of the call that has
// asked for it.
struct OwnCpu {
  std::int64_t ns, way_ns;
};

OwnCpu ReadOwnCpu(const shm::ClockPage& page) {
  timespec cpu;
  const std::uint64_t begun_tsc = shm::ReadTsc();
  RawSyscall(SYS_clock_gettime, CLOCK_THREAD_CPUTIME_ID, Arg(&cpu));
  const std::int64_t way_ns = NsSince(page, begun_tsc) / 2;
  return {shm::ToNs(cpu), shm::HostNsOf(page, way_ns < kMostCallNs ? way_ns : kMostCallNs)};
}

// Where only gates keep threads apart nothing stops the thread in the instant in which it notifies.
// A handler that ran after the gate is shut, and before the coordinator is told, would take itself
// for one that ends a wait. So until the destructor no handler runs.
class NoHandlers {
 public:
  // `blocked`: the signals that the program blocks, if they differ from the thread's.
  NoHandlers(shm::ThreadSlot& slot, const unsigned long* blocked) : page_(slot.clock) {
    if (g_header->is_unprivileged == 0) return;
    const unsigned long all = ~0ul;
    RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&all), Arg(&before_), kSetSize);
    slot.blocked_signals = blocked != nullptr ? *blocked : before_;
  }
  // The thread has left its gate: the time that it needs for this, too, is not its own.
  ~NoHandlers() {
    const std::uint64_t begun_tsc = shm::ReadTsc();
    if (Allow(0) && OnlyCpuClockTells(page_)) {
      shm::TakeOut(page_, shm::ReadClock(page_), NsSince(page_, begun_tsc), kMostCallNs);
    }
  }
  NoHandlers(const NoHandlers&) = delete;
  NoHandlers& operator=(const NoHandlers&) = delete;

  // Handlers may run, but for those of the signals `but`, which have to wait for the destructor.
  // False if all handlers may run already.
  bool Allow(unsigned long but) {
    if (g_header->is_unprivileged == 0 || allows_all_) return false;
    const unsigned long mask = before_ | but;
    RawSyscall(SYS_rt_sigprocmask, SIG_SETMASK, Arg(&mask), 0, kSetSize);
    allows_all_ = mask == before_;
    return true;
  }

 private:
  shm::ClockPage& page_;
  unsigned long before_ = 0;
  bool allows_all_ = false;
};

// Where a thread's charge stood when it last notified, and in which dispatch that was.
struct Charged {
  std::uint64_t dispatch = ~std::uint64_t{0};
  std::int64_t cpu_ns = 0;
};

void DieIfCoordinatorIsGone() {
  pollfd pipe{g_notify_fd, 0, 0};
  const timespec now{};
  if (RawSyscall(SYS_ppoll, Arg(&pipe), 1, Arg(&now), 0, 0) == 1 &&
      (pipe.revents & (POLLERR | POLLNVAL)) != 0) {
    DieWithoutCoordinator("that tcsim has ended");
  }
}

// The reading that the thread has come to, before it does anything for the exchange itself. Where
// the thread runs beside the coordinator, the coordinator could not read the thread's CPU clock at
// this instant.
shm::ClockReading ReadForNote(const shm::ThreadSlot& slot, shm::ClockPage& page) {
  for (;;) {
    shm::ClockReading reading = shm::ReadClock(page);
    const bool checks = RunsBeside(slot) && shm::IsCheckDue(page, reading);
    if (!checks && !OnlyCpuClockTells(page)) return reading;
    const OwnCpu own = ReadOwnCpu(page);
    const std::int64_t cpu_ns = own.ns - own.way_ns;
    const std::int64_t stolen_ns = reading.cpu_ns - shm::CpuTimeFromHostClock(page, cpu_ns);
    if (!shm::RemoveStolen(page, reading, cpu_ns)) continue;
    reading.cpu_ns -= stolen_ns;
    reading.time_ns -= stolen_ns;
    return reading;
  }
}

Charged FillRecord(shm::ThreadSlot& slot, const Request& request,
                   const shm::ClockReading& reading) {
  shm::Notification& note = slot.note;
  note.kind = request.kind;
  note.time_ns = shm::ShownTime(slot.clock, reading);
  note.deadline_ns = request.deadline_ns;
  memcpy(note.args, request.args, sizeof note.args);
  note.fd_count = request.fd_count;
  if (request.fd_count > 0) memcpy(note.fds, request.fds, request.fd_count * sizeof(shm::WaitFd));
  return {shm::DispatchNumber(reading.executed_word), reading.cpu_ns};
}

// Notifies for a thread that has come to that reading.
void Notify(const GuestThread& thread, const shm::ClockReading& reading) {
  shm::ThreadSlot& slot = *thread.slot;
  slot.stopped_tsc = reading.tsc;
  if (Saying runs = Saying::kRuns; slot.saying.compare_exchange_strong(runs, Saying::kSaid)) return;
  const bool ends_wait = slot.note.kind == NotificationKind::kInterrupted;
  const shm::PipeMessage message{thread.index, ends_wait ? 1u : 0u};
  for (;;) {
    const long n = RawSyscall(SYS_write, g_notify_fd, Arg(&message), sizeof message);
    if (n == static_cast<long>(sizeof message)) return;
    if (n == -EINTR) continue;
    DieWithoutCoordinator(n == -EBADF ? "it has closed the connection to it"
                                      : "that tcsim has ended");
  }
}

// Takes out the time of the way to the gate and out of it, and the time that others had meanwhile.
void TakeOutWait(shm::ClockPage& page, const Charged& at_notification, std::int64_t most_ns) {
  const OwnCpu own = ReadOwnCpu(page);
  const shm::ClockReading now = shm::ReadClock(page);
  const bool goes_on = shm::DispatchNumber(now.executed_word) == at_notification.dispatch;
  shm::LeaveGate(page, now, goes_on ? at_notification.cpu_ns : page.base_cpu_ns,
                 own.ns + own.way_ns, most_ns);
}

// Takes out what the clock has counted since the notification, in the thread's turn: the
// coordinator has let the thread go on, at once or in another turn.
void TakeOutWayOut(shm::ClockPage& page, const Charged& at_notification) {
  const shm::ClockReading now = shm::ReadClock(page);
  const std::int64_t begun_ns = std::max(at_notification.cpu_ns, page.base_cpu_ns);
  shm::TakeOut(page, now, now.cpu_ns - begun_ns, kMostGateNs);
}

// How many handlers of a thread's had begun before it waits; a handler that begins later ends the
// wait. Null: no handler ends the wait.
using HandlersBefore = const std::uint32_t*;

// False if a signal handler has run and the gate is still shut.
bool WaitAtGate(shm::ThreadSlot& slot, HandlersBefore handlers, const Charged& charged,
                std::int64_t most_ns = shm::kMostExchangeNs) {
  for (;;) {
    std::uint32_t gate = slot.gate.load(std::memory_order_acquire);
    if (gate == shm::kGateOpen || IsShutDown()) {
      if (slot.wake_reason.load(std::memory_order_relaxed) == WakeReason::kCutOff) {
        DieWithoutCoordinator("what it says does not arrive (the connection is another file now)");
      }
      if (OnlyCpuClockTells(slot.clock) || RunsBeside(slot)) {
        TakeOutWait(slot.clock, charged, most_ns);
      } else {
        TakeOutWayOut(slot.clock, charged);
      }
      return true;
    }
    if (gate == shm::kGateClosed && !slot.gate.compare_exchange_strong(gate, shm::kGateWaiting)) {
      continue;
    }
    // A handler that begins after this look shuts the gate anew (NoteHandler), and the kernel does
    // not wait.
    if (handlers != nullptr && OwnState().handlers != *handlers) return false;
    const long result =
        RawSyscall(SYS_futex, Arg(&slot.gate), FUTEX_WAIT, shm::kGateWaiting, Arg(&kGateTurn));
    if (result == -ETIMEDOUT) DieIfCoordinatorIsGone();
    if (result == -EINTR && handlers != nullptr &&
        slot.gate.load(std::memory_order_acquire) != shm::kGateOpen) {
      return false;
    }
  }
}

// False if the gate is open already.
bool ShutGate(shm::ThreadSlot& slot) {
  std::uint32_t gate = slot.gate.load(std::memory_order_acquire);
  while (gate != shm::kGateOpen) {
    if (slot.gate.compare_exchange_weak(gate, shm::kGateClosed)) return true;
  }
  return false;
}

// Waits until the coordinator has taken what the thread has said, if it has said something: until
// then the slot may say nothing else.
void AwaitTaken(shm::ThreadSlot& slot) {
  for (;;) {
    Saying saying = slot.saying.load(std::memory_order_acquire);
    if (IsShutDown() || (saying != Saying::kSaid && saying != Saying::kSaidAndWaits)) return;
    if (saying == Saying::kSaid &&
        !slot.saying.compare_exchange_strong(saying, Saying::kSaidAndWaits)) {
      continue;
    }
    const long result = RawSyscall(SYS_futex, Arg(&slot.saying), FUTEX_WAIT,
                                   static_cast<long>(Saying::kSaidAndWaits), Arg(&kGateTurn));
    if (result == -ETIMEDOUT) DieIfCoordinatorIsGone();
  }
}

enum class Ended {
  kWait,     // the coordinator has been told of the wait
  kNothing,  // the thread did not wait
  kByOther,  // something else has ended the wait: the gate is open
};

// Tells the coordinator that a signal has ended the wait.
Ended EndWait(GuestThread& thread) {
  shm::ThreadSlot& slot = *thread.slot;
  AwaitTaken(slot);
  const shm::ClockReading reading = ReadForNote(slot, slot.clock);
  NoHandlers none(slot, nullptr);
  // The handler may have begun before the thread's turn. If the turn begins after this look, the
  // coordinator makes nothing of what it is told.
  if (!ShutGate(slot)) return Ended::kByOther;
  const NotificationKind kind = slot.note.kind;
  if (kind != NotificationKind::kInterrupted && kind != NotificationKind::kResumed)
    slot.interrupted = slot.note;
  const Charged charged =
      FillRecord(slot, Request{.kind = NotificationKind::kInterrupted}, reading);
  Notify(thread, reading);
  none.Allow(0);
  WaitAtGate(slot, nullptr, charged);
  if (slot.note.kind == NotificationKind::kResumed) return Ended::kByOther;
  return slot.reply[0] != 0 ? Ended::kWait : Ended::kNothing;
}

Reply ExchangeOnce(GuestThread& thread, const Request& request) {
  shm::ThreadSlot& slot = *thread.slot;
  const shm::ClockReading reading = ReadForNote(slot, slot.clock);
  NoHandlers none(slot, request.blocked);
  slot.gate.store(shm::kGateClosed, std::memory_order_relaxed);
  const Charged charged = FillRecord(slot, request, reading);
  Notify(thread, reading);
  if (request.suspend_mask != nullptr) {
    const unsigned long mask = *request.suspend_mask | OwnSignalsHeldInWaits();
    RawSyscall(SYS_rt_sigsuspend, Arg(&mask), kSetSize);
    none.Allow(0);
    // The thread was dispatched before the signal was sent, unless the signal came from somebody
    // else.
    if (slot.gate.load(std::memory_order_acquire) != shm::kGateOpen) EndWait(thread);
    return Reply{WakeReason::kSignal, {0, 0}};
  }
  const std::uint32_t handlers = thread.handlers;
  // The coordinator's own signal is no end of a wait.
  none.Allow(request.interruptible ? OwnSignalsHeldInWaits() : 0);
  if (!WaitAtGate(slot, request.interruptible ? &handlers : nullptr, charged)) {
    const Ended ended = EndWait(thread);
    if (g_header->is_unprivileged == 0 && ended != Ended::kByOther) {
      return Reply{WakeReason::kSignal, {0, 0}};
    }
  }
  return Reply{slot.wake_reason.load(std::memory_order_relaxed), {slot.reply[0], slot.reply[1]}};
}

// The state of the exchange that a handler has interrupted, which the handler must leave as it was.
struct Interrupted {
  shm::Notification note;
  std::uint32_t gate;
  WakeReason reason;
  std::int64_t reply[2];

  explicit Interrupted(GuestThread& thread) {
    shm::ThreadSlot& slot = *thread.slot;
    AwaitTaken(slot);
    note = slot.note;
    gate = slot.gate.load();
    const Ended ended = gate == shm::kGateOpen ? Ended::kByOther : EndWait(thread);
    if (ended == Ended::kByOther || g_header->is_unprivileged != 0) {
      gate = shm::kGateOpen;
    } else if (ended == Ended::kWait) {
      gate = shm::kGateOpen;
      reason = WakeReason::kSignal;
      reply[0] = reply[1] = 0;
      return;
    }
    if (gate == shm::kGateWaiting) gate = shm::kGateClosed;
    reason = slot.wake_reason.load();
    reply[0] = slot.reply[0];
    reply[1] = slot.reply[1];
  }

  // The time that the handler has computed is no part of the exchange that it interrupted.
  void PutBack(shm::ThreadSlot& slot) const {
    slot.note = note;
    slot.note.time_ns = shm::ShownTime(slot.clock, shm::ReadClock(slot.clock));
    slot.reply[0] = reply[0];
    slot.reply[1] = reply[1];
    slot.wake_reason.store(reason);
    slot.gate.store(gate);
  }
};

// Makes an exchange in whatever the thread does: the thread may be in a handler that has
// interrupted another exchange.
Reply ExchangeAnywhere(GuestThread& thread, const Request& request) {
  Reply reply;
  const PausedOwnWork paused(thread);
  if (thread.depth++ == 0) {
    reply = ExchangeOnce(thread, request);
  } else {
    const Interrupted outer(thread);
    reply = ExchangeOnce(thread, request);
    outer.PutBack(*thread.slot);
  }
  --thread.depth;
  return reply;
}

}  // namespace

// A wait that was to end for a signal of the process's may find that another thread has taken the
// signal: no handler has run in this thread. As the kernel has it, the thread waits on.
Reply Exchange(GuestThread& thread, const Request& request) {
  const bool waits = request.interruptible || request.suspend_mask != nullptr;
  for (;;) {
    if (IsShutDown()) return Reply{WakeReason::kGo, {0, 0}};
    if (waits) pthread_testcancel();
    const std::uint32_t handlers = thread.handlers;
    const Reply reply = ExchangeAnywhere(thread, request);
    if (!waits || reply.reason != WakeReason::kSignal) return reply;
    if (thread.handlers != handlers || !request.interruptible) {
      pthread_testcancel();
      return reply;
    }
  }
}

void AwaitTurn(GuestThread& thread) {
  if (!IsShutDown()) Exchange(thread, Request{.kind = NotificationKind::kCall});
}

void NoteHandler(GuestThread& thread) {
  ++thread.handlers;
  if (thread.depth == 0) return;
  std::uint32_t gate = shm::kGateWaiting;
  thread.slot->gate.compare_exchange_strong(gate, shm::kGateClosed);
}

void AwaitTurnOfHandler(GuestThread& thread) {
  if (g_header->is_unprivileged == 0 || IsShutDown() || !IsAtGate(thread)) return;
  ++thread.depth;
  Interrupted(thread).PutBack(*thread.slot);
  --thread.depth;
}

bool IsBeside(const GuestThread& thread) { return RunsBeside(*thread.slot); }

bool IsAtGate(const GuestThread& thread) {
  return thread.depth > 0 && thread.slot->gate.load(std::memory_order_acquire) != shm::kGateOpen;
}

void AwaitFirstDispatch(GuestThread& thread) {
  WaitAtGate(*thread.slot, nullptr, {},
             g_header->has_brokers != 0 ? shm::kMostAttachNs : shm::kMostExchangeNs);
}

void AwaitDispatch(GuestThread& thread) { WaitAtGate(*thread.slot, nullptr, {}); }

}  // namespace tcs::preload
