// timer_create and its kin. The coordinator keeps the timers and sends their signals. Programs of
// before glibc 2.3.3, whose timer_t was an int, do not exist here: all versions are one.
#include <errno.h>
#include <linux/timerfd.h>
#include <pthread.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <time.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/posix_timers.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/clock_ids.h"

using namespace tcs::preload;
using tcs::shm::ClockKind;
using tcs::shm::ClockOfId;
using tcs::shm::FirstExpiry;
using tcs::shm::NotificationKind;
using tcs::shm::TimeLeft;
using tcs::shm::TimerClock;
using tcs::shm::TimerKind;

namespace {

bool IsThread(GuestThread& t, int tid) {
  return tid > 0 && RawSyscall(SYS_tgkill, t.slot->pid, tid, 0) == 0;
}

// 0, or the error of timer_create.
int KindOfClock(GuestThread& t, clockid_t id, TimerKind* kind) {
  const ClockOfId clock = tcs::shm::ClockOf(id);
  if (const int error = ErrorOfTimerOn(clock); error != 0) return error;
  if (clock.kind == ClockKind::kProcessCpu) {
    kind->clock = TimerClock::kProcessCpu;
    return clock.owner == 0 || clock.owner == t.slot->pid ? 0 : EINVAL;
  }
  if (clock.kind == ClockKind::kThreadCpu) {
    kind->clock = TimerClock::kThreadCpu;
    kind->clock_tid = clock.owner == 0 ? t.slot->tid : clock.owner;
    return clock.owner == 0 || IsThread(t, clock.owner) ? 0 : EINVAL;
  }
  return 0;
}

int KindOfEvent(GuestThread& t, const sigevent& event, TimerKind* kind) {
  switch (event.sigev_notify) {
    case SIGEV_NONE:
    case SIGEV_THREAD:
      return 0;
    case SIGEV_THREAD_ID:
      kind->signal_tid = event._sigev_un._tid;
      if (!IsThread(t, kind->signal_tid)) return EINVAL;
      [[fallthrough]];
    case SIGEV_SIGNAL:
      kind->signal = event.sigev_signo;
      kind->value = reinterpret_cast<std::int64_t>(event.sigev_value.sival_ptr);
      return kind->signal > 0 && kind->signal < 65 ? 0 : EINVAL;
    default:
      return EINVAL;
  }
}

// Keeps what the timer's threads need: from the program's attributes, as they are now.
void KeepThread(const sigevent& event, PosixTimer* timer) {
  timer->function = event.sigev_notify_function;
  timer->value = event.sigev_value;
  pthread_attr_t defaults;
  pthread_attr_init(&defaults);
  const pthread_attr_t* given = event.sigev_notify_attributes;
  if (given == nullptr) given = &defaults;
  pthread_attr_getstacksize(given, &timer->stack_size);
  pthread_attr_getguardsize(given, &timer->guard_size);
  pthread_attr_destroy(&defaults);
}

// 0 or the error; on an error the caller frees the timer.
int Make(GuestThread& t, const sigevent& event, const TimerKind& kind, PosixTimer* timer) {
  const bool threaded = event.sigev_notify == SIGEV_THREAD;
  timer->timer_fd = -1;
  timer->overruns = 0;
  if (threaded) {
    timer->timer_fd =
        static_cast<int>(RawSyscall(SYS_timerfd_create, CLOCK_MONOTONIC, TFD_CLOEXEC));
    if (timer->timer_fd < 0) return EAGAIN;
    KeepThread(event, timer);
  }
  Request request{.kind = NotificationKind::kTimerCreate, .args = {timer->timer_fd}};
  __builtin_memcpy(&request.args[1], &kind, sizeof kind);
  timer->id = Exchange(t, request).values[0];
  int error = timer->id >= tcs::shm::kFirstTimerId ? 0 : EAGAIN;
  __atomic_store_n(&timer->state, PosixTimer::kLive, __ATOMIC_RELEASE);
  if (error == 0 && threaded && !StartTimerThread(timer)) {
    Exchange(t, Request{.kind = NotificationKind::kTimerDelete, .args = {timer->id}});
    error = EAGAIN;
  }
  if (error != 0 && threaded) RawSyscall(SYS_close, timer->timer_fd);
  return error;
}

// The time that the timer's clock shows, in the coordinator's terms: virtual or charged time. A
// clock of another thread is read where that thread last stopped.
std::int64_t NowOn(GuestThread& t, const PosixTimer& timer) {
  TimerKind kind;
  KindOfClock(t, timer.clock, &kind);
  if (kind.clock == TimerClock::kTime) return NowNs(t);
  timespec now{};
  clock_gettime(timer.clock, &now);
  return ToNs(now);
}

std::int64_t OffsetOf(clockid_t id) {
  const ClockOfId clock = tcs::shm::ClockOf(id);
  if (!clock.IsOfTime()) return 0;
  return OffsetNs(clock.kind == ClockKind::kRealtime ? Clock::kRealtime : Clock::kMonotonic);
}

itimerspec ToSpec(const Reply& reply, std::int64_t now) {
  return itimerspec{ToTimespec(reply.values[1]), ToTimespec(TimeLeft(reply.values[0], now))};
}

}  // namespace

TCS_EXPORT int timer_create(clockid_t clock, sigevent* __restrict given,
                            timer_t* __restrict name) noexcept {
  const Entered t;
  if (t == nullptr || IsShutDown()) return TCS_REAL(timer_create)(clock, given, name);
  TimerKind kind;
  kind.is_posix = 1;
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  if (given != nullptr) event = *given;
  if (const int error = KindOfClock(*t, clock, &kind); error != 0) return Fail(error);
  if (const int error = KindOfEvent(*t, event, &kind); error != 0) return Fail(error);
  PosixTimer* timer = ClaimPosixTimer();
  if (timer == nullptr) return Fail(EAGAIN);
  timer->clock = clock;
  if (const int error = Make(*t, event, kind, timer); error != 0) {
    FreePosixTimer(timer);
    return Fail(error);
  }
  *name = reinterpret_cast<timer_t>(timer->id);
  return 0;
}

TCS_EXPORT int timer_delete(timer_t name) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(timer_delete)(name);
  PosixTimer* timer = FindPosixTimer(name);
  if (timer == nullptr) return Fail(EINVAL);
  __atomic_store_n(&timer->state, PosixTimer::kEnding, __ATOMIC_RELEASE);
  Exchange(*t, Request{.kind = NotificationKind::kTimerDelete, .args = {timer->id}});
  if (timer->timer_fd < 0) {
    FreePosixTimer(timer);
    return 0;
  }
  // Wakes the timer's helper.
  const std::uint64_t once = 1;
  if (RawSyscall(SYS_ioctl, timer->timer_fd, TFD_IOC_SET_TICKS, Arg(&once)) != 0) {
    const itimerspec past{{0, 0}, {0, 1}};
    RawSyscall(SYS_timerfd_settime, timer->timer_fd, TFD_TIMER_ABSTIME, Arg(&past));
  }
  return 0;
}

TCS_EXPORT int timer_settime(timer_t name, int flags, const itimerspec* __restrict given,
                             itimerspec* __restrict old) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(timer_settime)(name, flags, given, old);
  const PosixTimer* timer = FindPosixTimer(name);
  if (given == nullptr) return Fail(EINVAL);
  itimerspec value;
  if (!CopyIn(&value, given)) return Fail(EFAULT);
  if (!IsValid(value)) return Fail(EINVAL);
  if (timer == nullptr) return Fail(EINVAL);
  const std::int64_t now = NowOn(*t, *timer);
  const bool is_absolute = (flags & TIMER_ABSTIME) != 0;
  const bool is_date =
      is_absolute && tcs::shm::ClockOf(timer->clock).kind == tcs::shm::ClockKind::kRealtime;
  const std::int64_t first =
      FirstExpiry(ToNs(value.it_value), is_absolute, now, OffsetOf(timer->clock));
  const Reply before =
      Exchange(*t, Request{.kind = NotificationKind::kTimerSet,
                           .args = {timer->id, first, ToNs(value.it_interval), is_date ? 1 : 0}});
  return old == nullptr || CopyOut(old, ToSpec(before, now)) ? 0 : Fail(EFAULT);
}

TCS_EXPORT int timer_gettime(timer_t name, itimerspec* value) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(timer_gettime)(name, value);
  const PosixTimer* timer = FindPosixTimer(name);
  if (timer == nullptr) return Fail(EINVAL);
  const Reply reply =
      Exchange(*t, Request{.kind = NotificationKind::kTimerGet, .args = {timer->id}});
  return CopyOut(value, ToSpec(reply, NowOn(*t, *timer))) ? 0 : Fail(EFAULT);
}

TCS_EXPORT int timer_getoverrun(timer_t name) noexcept {
  const Entered t;
  if (t == nullptr) return TCS_REAL(timer_getoverrun)(name);
  const PosixTimer* timer = FindPosixTimer(name);
  if (timer == nullptr) return Fail(EINVAL);
  if (timer->timer_fd >= 0) return __atomic_load_n(&timer->overruns, __ATOMIC_RELAXED);
  const Reply reply =
      Exchange(*t, Request{.kind = NotificationKind::kTimerOverrun, .args = {timer->id}});
  return static_cast<int>(reply.values[0]);
}
