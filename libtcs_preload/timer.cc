// setitimer, alarm and timerfd. The coordinator keeps the timers; it sends real signals, and makes
// real descriptors readable: a timerfd is the kernel's own, whose timer never runs there, and the
// coordinator says how often it has run out.
#include <errno.h>
#include <fcntl.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/timer_fds.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/clock_ids.h"

using namespace tcs::preload;
using tcs::shm::FirstExpiry;
using tcs::shm::NotificationKind;
using tcs::shm::RoundUpToTimeval;
using tcs::shm::TimeLeft;

namespace {

struct TimerValue {
  std::int64_t next_ns;  // 0: not armed
  std::int64_t interval_ns;
};

TimerValue Ask(GuestThread& t, NotificationKind kind, std::int64_t id, std::int64_t first,
               std::int64_t interval, bool is_date = false) {
  const Reply reply =
      Exchange(t, Request{.kind = kind, .args = {id, first, interval, is_date ? 1 : 0}});
  return TimerValue{reply.values[0], reply.values[1]};
}

// `now` is the clock that the timer runs on: virtual time, or charged processor time.
template <class Spec, class ToUnit>
Spec ToSpec(const TimerValue& value, std::int64_t now, ToUnit to_unit) {
  return Spec{to_unit(value.interval_ns), to_unit(TimeLeft(value.next_ns, now))};
}

std::int64_t ItimerNow(GuestThread& t, int which) {
  return which == ITIMER_REAL ? NowNs(t) : ProcessCpuNs(t);
}

int SetItimer(GuestThread& t, int which, const itimerval* value, itimerval* old) {
  itimerval given{};
  if (value != nullptr && !CopyIn(&given, value)) return Fail(EFAULT);
  if (which < ITIMER_REAL || which > ITIMER_PROF) return Fail(EINVAL);
  if (!IsValid(given)) return Fail(EINVAL);
  const std::int64_t now = ItimerNow(t, which);
  const std::int64_t first = FirstExpiry(ToNs(given.it_value), false, now, 0);
  const TimerValue before =
      Ask(t, NotificationKind::kTimerSet, which, first, ToNs(given.it_interval));
  if (old == nullptr) return 0;
  return CopyOut(old, ToSpec<itimerval>(before, now, RoundUpToTimeval)) ? 0 : Fail(EFAULT);
}

}  // namespace

TCS_EXPORT int setitimer(__itimer_which_t which, const itimerval* __restrict value,
                         itimerval* __restrict old) noexcept {
  const Entered t;
  if (t == nullptr)
    return static_cast<int>(ToErrno(RawSyscall(SYS_setitimer, which, Arg(value), Arg(old))));
  return SetItimer(*t, which, value, old);
}

TCS_EXPORT int getitimer(__itimer_which_t which, itimerval* value) noexcept {
  const Entered t;
  if (t == nullptr) return static_cast<int>(ToErrno(RawSyscall(SYS_getitimer, which, Arg(value))));
  if (which < ITIMER_REAL || which > ITIMER_PROF) return Fail(EINVAL);
  const TimerValue now_set = Ask(*t, NotificationKind::kTimerGet, which, 0, 0);
  const auto left = ToSpec<itimerval>(now_set, ItimerNow(*t, which), RoundUpToTimeval);
  return CopyOut(value, left) ? 0 : Fail(EFAULT);
}

TCS_EXPORT unsigned alarm(unsigned seconds) {
  itimerval value{{0, 0}, {seconds, 0}}, old{};
  setitimer(ITIMER_REAL, &value, &old);
  return static_cast<unsigned>(tcs::shm::AlarmSeconds(old.it_value));
}

TCS_EXPORT useconds_t ualarm(useconds_t first, useconds_t interval) {
  itimerval value{{interval / 1'000'000, interval % 1'000'000},
                  {first / 1'000'000, first % 1'000'000}};
  itimerval old{};
  if (setitimer(ITIMER_REAL, &value, &old) != 0) return static_cast<useconds_t>(-1);
  return static_cast<useconds_t>(old.it_value.tv_sec * 1'000'000 + old.it_value.tv_usec);
}

TCS_EXPORT int timerfd_create(int clock, int flags) {
  const Entered t;
  if (t == nullptr || IsShutDown()) {
    return static_cast<int>(ToErrno(RawSyscall(SYS_timerfd_create, clock, flags)));
  }
  if ((flags & ~(TFD_CLOEXEC | TFD_NONBLOCK)) != 0) return Fail(EINVAL);
  const tcs::shm::ClockOfId known = tcs::shm::ClockOf(clock);
  if (!known.IsOfTime() || known.is_read_only || clock == CLOCK_TAI) return Fail(EINVAL);
  const bool is_real = known.kind == tcs::shm::ClockKind::kRealtime;
  const Clock base = is_real ? Clock::kRealtime : Clock::kMonotonic;
  const long fd = RawSyscall(SYS_timerfd_create, clock, flags);
  if (fd < 0) return static_cast<int>(ToErrno(fd));
  tcs::shm::TimerKind kind;
  kind.clock_tid = is_real ? 1 : 0;
  Request request{.kind = NotificationKind::kTimerCreate, .args = {fd}};
  __builtin_memcpy(&request.args[1], &kind, sizeof kind);
  const TimerValue made{Exchange(*t, request).values[0], 0};
  if (made.next_ns < tcs::shm::kFirstTimerId ||
      !RememberTimerFd(static_cast<int>(fd), made.next_ns, base)) {
    RawSyscall(SYS_close, fd);
    return Fail(EMFILE);
  }
  return static_cast<int>(fd);
}

TCS_EXPORT int timerfd_settime(int fd, int flags, const itimerspec* given, itimerspec* old) {
  const Entered t;
  const TimerFd* timer = t == nullptr ? nullptr : FindTimerFd(fd);
  if (timer == nullptr) {  // the coordinator knows a timer that was made raw, or by another program
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_timerfd_settime, fd, flags, Arg(given), Arg(old), 0, kTrapped)));
  }
  itimerspec value;
  if (!CopyIn(&value, given)) return Fail(EFAULT);
  if ((flags & ~(TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET)) != 0) return Fail(EINVAL);
  if (!IsValid(value)) return Fail(EINVAL);
  const std::int64_t now = NowNs(*t);
  const bool is_absolute = (flags & TFD_TIMER_ABSTIME) != 0;
  const std::int64_t first =
      FirstExpiry(ToNs(value.it_value), is_absolute, now, OffsetNs(timer->clock));
  const std::int64_t interval = ToNs(value.it_interval);
  NoteShortTimer(timer->id, interval > 0 && interval < tcs::shm::kShortIntervalNs);
  const TimerValue before = Ask(*t, NotificationKind::kTimerSet, timer->id, first, interval,
                                is_absolute && timer->clock == Clock::kRealtime);
  if (old == nullptr) return 0;
  return CopyOut(old, ToSpec<itimerspec>(before, now, ToTimespec)) ? 0 : Fail(EFAULT);
}

TCS_EXPORT int timerfd_gettime(int fd, itimerspec* value) {
  const Entered t;
  const TimerFd* timer = t == nullptr ? nullptr : FindTimerFd(fd);
  if (timer == nullptr)
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_timerfd_gettime, fd, Arg(value), 0, 0, 0, kTrapped)));
  const TimerValue set = Ask(*t, NotificationKind::kTimerGet, timer->id, 0, 0);
  return CopyOut(value, ToSpec<itimerspec>(set, NowNs(*t), ToTimespec)) ? 0 : Fail(EFAULT);
}
