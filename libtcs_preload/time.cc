// Reading and setting clocks.
#include <errno.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/timeb.h>
#include <sys/times.h>
#include <sys/timex.h>
#include <time.h>
#include <unistd.h>

#include "libtcs_preload/clock_calls.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/shown_usage.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/clock_ids.h"

using namespace tcs::preload;
using tcs::shm::ClockKind;
using tcs::shm::ClockOfId;

namespace {

// Virtual ns, or -1 for a clock that the kernel has to judge.
std::int64_t ReadClock(GuestThread& t, const ClockOfId& clock) {
  switch (clock.kind) {
    case ClockKind::kRealtime:
      return NowNs(t) + OffsetNs(Clock::kRealtime);
    case ClockKind::kMonotonic:
      return NowNs(t) + OffsetNs(Clock::kMonotonic);
    case ClockKind::kProcessCpu:
      return clock.owner == 0 || clock.owner == t.slot->pid ? ProcessCpuNs(t) : -1;
    case ClockKind::kThreadCpu:
      return clock.owner == 0 || clock.owner == t.slot->tid ? ThreadCpuNs(t) : -1;
    default:
      return -1;
  }
}

// Sets the date from now on; returns 0, or -1 with errno.
int SetDate(GuestThread& t, std::int64_t date_ns) {
  HoldForWrite(t);
  const Reply reply =
      Exchange(t, Request{.kind = tcs::shm::NotificationKind::kSetDate, .args = {date_ns}});
  return reply.values[0] == 0 ? 0 : Fail(static_cast<int>(-reply.values[0]));
}

// By adjtimex: a step is all that a clock which nothing disciplines can be told.
int StepDate(GuestThread& t, const timex& step) {
  constexpr unsigned kNanoseconds = ADJ_NANO;
  if ((step.modes & ~kNanoseconds) != ADJ_SETOFFSET) return Fail(EPERM);
  const std::int64_t most = (step.modes & kNanoseconds) != 0 ? kNsPerSecond : 1'000'000;
  if (step.time.tv_usec < 0 || step.time.tv_usec >= most) return Fail(EINVAL);
  const std::int64_t fraction = step.time.tv_usec * (kNsPerSecond / most);
  const std::int64_t now = NowNs(t) + OffsetNs(Clock::kRealtime);
  return SetDate(t, AddSaturated(now, AddSaturated(ToNs(timespec{step.time.tv_sec, 0}), fraction)));
}

}  // namespace

namespace tcs::preload {

long ClockGettime(clockid_t id, timespec* ts) {
  GuestThread* const t = Enter(Concern::kNobody);
  if (t != nullptr) {
    const ClockOfId clock = tcs::shm::ClockOf(id);
    const std::int64_t ns = ReadClock(*t, clock);
    if (ns >= 0) {
      // The other clocks are read without the kernel natively, too.
      if (clock.IsOfCpu()) return CopyOut(ts, ToTimespec(ns)) ? 0 : -EFAULT;
      *ts = ToTimespec(ns);
      return 0;
    }
  }
  // The coordinator knows the processor time of others. Without the mark this call reaches the
  // coordinator.
  if (t != nullptr && tcs::shm::ClockOf(id).IsOfCpu()) {
    return RawSyscall(SYS_clock_gettime, id, Arg(ts), 0, 0, 0, 0);
  }
  return RawSyscall(SYS_clock_gettime, id, Arg(ts));
}

long Gettimeofday(timeval* tv, void* zone) {
  GuestThread* const t = Enter(Concern::kNobody);
  if (t == nullptr) return RawSyscall(SYS_gettimeofday, Arg(tv), Arg(zone));
  if (zone != nullptr) RawSyscall(SYS_gettimeofday, 0, Arg(zone));
  if (tv != nullptr) *tv = ToTimeval(NowNs(*t) + OffsetNs(Clock::kRealtime));
  return 0;
}

time_t Time(time_t* out) {
  timespec now;
  ClockGettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}

long ClockGetres(clockid_t id, timespec* resolution) {
  const ClockOfId clock = tcs::shm::ClockOf(id);
  if (id < 0 && clock.IsOfCpu()) {
    // The kernel knows whether there is such a process or thread.
    if (const long error = RawSyscall(SYS_clock_getres, id, 0); error != 0) return error;
  }
  if (Enter(Concern::kNobody) != nullptr && clock.kind != ClockKind::kNone) {
    if (resolution != nullptr) *resolution = timespec{0, 1};
    return 0;
  }
  return RawSyscall(SYS_clock_getres, id, Arg(resolution));
}

}  // namespace tcs::preload

TCS_EXPORT int clock_gettime(clockid_t id, timespec* ts) {
  return static_cast<int>(ToErrno(ClockGettime(id, ts)));
}

TCS_EXPORT int __clock_gettime(clockid_t id, timespec* ts) { return clock_gettime(id, ts); }

TCS_EXPORT int gettimeofday(timeval* __restrict tv, void* __restrict zone) {
  return static_cast<int>(ToErrno(Gettimeofday(tv, zone)));
}

TCS_EXPORT int __gettimeofday(timeval* __restrict tv, void* __restrict zone) {
  return gettimeofday(tv, zone);
}

TCS_EXPORT time_t time(time_t* out) { return Time(out); }

TCS_EXPORT int ftime(timeb* out) {
  timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  *out = timeb{now.tv_sec, static_cast<unsigned short>(now.tv_nsec / 1'000'000), 0, 0};
  return 0;
}

TCS_EXPORT int timespec_get(timespec* ts, int base) {
  return base == TIME_UTC && clock_gettime(CLOCK_REALTIME, ts) == 0 ? base : 0;
}

TCS_EXPORT int timespec_getres(timespec* resolution, int base) noexcept {
  return base == TIME_UTC && clock_getres(CLOCK_REALTIME, resolution) == 0 ? base : 0;
}

TCS_EXPORT clock_t clock(void) {
  timespec cpu;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return ToNs(cpu) / 1000;
}

TCS_EXPORT clock_t times(tms* out) {
  GuestThread* const t = Enter(Concern::kNobody);
  if (t == nullptr) return ToErrno(RawSyscall(SYS_times, Arg(out)));
  const std::int64_t tick = kNsPerSecond / sysconf(_SC_CLK_TCK);
  if (out != nullptr) {
    *out = tms{ProcessCpuNs(*t) / tick, 0, ChildrenCpuNs(*t) / tick, 0};
  }
  return (NowNs(*t) + OffsetNs(Clock::kMonotonic)) / tick;
}

TCS_EXPORT int getrusage(__rusage_who_t who, rusage* usage) noexcept {
  const long result = RawSyscall(SYS_getrusage, who, Arg(usage));
  GuestThread* const t = Enter(Concern::kNobody);
  if (t == nullptr || result != 0) return static_cast<int>(ToErrno(result));
  const std::int64_t charged = who == RUSAGE_SELF       ? ProcessCpuNs(*t)
                               : who == RUSAGE_CHILDREN ? ChildrenCpuNs(*t)
                                                        : ThreadCpuNs(*t);
  ChargeInsteadOfMeasure(usage, charged);
  return 0;
}

TCS_EXPORT int clock_getres(clockid_t id, timespec* resolution) {
  return static_cast<int>(ToErrno(ClockGetres(id, resolution)));
}

TCS_EXPORT int __clock_getres(clockid_t id, timespec* resolution) {
  return clock_getres(id, resolution);
}

TCS_EXPORT int clock_settime(clockid_t id, const timespec* ts) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(ToErrno(RawSyscall(SYS_clock_settime, id, Arg(ts), 0, 0, 0, kTrapped)));
  }
  if (id != CLOCK_REALTIME) return Fail(EINVAL);
  timespec date;
  if (!CopyIn(&date, ts)) return Fail(EFAULT);
  return IsValid(date) ? SetDate(*t, ToNs(date)) : Fail(EINVAL);
}

TCS_EXPORT int settimeofday(const timeval* tv, const struct timezone* zone) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(
        ToErrno(RawSyscall(SYS_settimeofday, Arg(tv), Arg(zone), 0, 0, 0, kTrapped)));
  }
  if (tv == nullptr) return zone == nullptr ? 0 : Fail(EPERM);  // the time zone is the host's
  timeval date;
  if (!CopyIn(&date, tv)) return Fail(EFAULT);
  return zone == nullptr && IsValid(date) ? SetDate(*t, ToNs(date)) : Fail(EINVAL);
}

// The headers have forgotten stime, older programs have not.
TCS_EXPORT int SetTime(const time_t*) __asm__("stime");
TCS_EXPORT int SetTime(const time_t* seconds) {
  const timespec ts{*seconds, 0};
  return clock_settime(CLOCK_REALTIME, &ts);
}

// The adjustment can be read, with the virtual time in it, and the date be set by a step.
TCS_EXPORT int adjtimex(timex* tx) {
  const Entered t;
  if (!CanRead(tx, sizeof *tx)) return Fail(EFAULT);
  if (t == nullptr) {
    return static_cast<int>(ToErrno(RawSyscall(SYS_adjtimex, Arg(tx), 0, 0, 0, 0, kTrapped)));
  }
  const unsigned modes = tx->modes;
  if (modes != 0 && StepDate(*t, *tx) != 0) return -1;
  tx->modes = 0;  // the host's clock is only read
  const long state = RawSyscall(SYS_adjtimex, Arg(tx));
  tx->modes = modes;
  if (state >= 0) {
    tcs::shm::ShowUndisciplined(NowNs(*t) + OffsetNs(Clock::kRealtime), tx);
  }
  return static_cast<int>(ToErrno(state));
}

TCS_EXPORT int ntp_adjtime(timex* tx) { return adjtimex(tx); }

// The headers give ntp_gettimex this name; the function of this name knew fewer fields.
TCS_EXPORT int ntp_gettime(ntptimeval* out) noexcept {
  timex tx{};
  const int state = adjtimex(&tx);
  if (state >= 0) *out = ntptimeval{tx.time, tx.maxerror, tx.esterror, tx.tai, 0, 0, 0, 0};
  return state;
}

TCS_EXPORT int OldNtpGetTime(ntptimeval*) __asm__("ntp_gettime");
TCS_EXPORT int OldNtpGetTime(ntptimeval* out) {
  ntptimeval all{};
  const int state = ntp_gettime(&all);
  if (state >= 0) {
    out->time = all.time;
    out->maxerror = all.maxerror;
    out->esterror = all.esterror;
  }
  return state;
}

TCS_EXPORT int clock_adjtime(clockid_t id, timex* tx) {
  if (id == CLOCK_REALTIME) return adjtimex(tx);
  if (!CanRead(tx, sizeof *tx)) return Fail(EFAULT);
  // No other clock can be adjusted, the kernel says.
  Enter();
  return static_cast<int>(ToErrno(RawSyscall(SYS_clock_adjtime, id, Arg(tx))));
}

TCS_EXPORT int adjtime(const timeval* delta, timeval* old) {
  if (Enter() != nullptr) {
    if (delta != nullptr) return Fail(EPERM);
    if (old != nullptr) *old = timeval{0, 0};
    return 0;
  }
  return Fail(ENOSYS);
}
