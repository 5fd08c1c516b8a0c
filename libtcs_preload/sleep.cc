// Sleeping.
#include <errno.h>
#include <pthread.h>
#include <threads.h>
#include <time.h>
#include <unistd.h>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

namespace {

// Sleeps for `duration_ns`. Returns 0, or EINTR with what remained in *remaining_ns.
int SleepFor(GuestThread& t, std::int64_t duration_ns, std::int64_t* remaining_ns) {
  pthread_testcancel();
  const Now now = ReadNow(t);
  const std::int64_t deadline = AddSaturated(now.shown_ns, duration_ns);
  if (SleepUntil(t, now.reading, deadline)) return 0;
  const std::int64_t rest = deadline - NowNs(t);
  *remaining_ns = rest > 0 ? rest : 0;
  return EINTR;
}

// Of a process or a thread, by its number: a thread cannot sleep until it has computed.
int ErrorOfCpuClock(const GuestThread& t, clockid_t id) {
  constexpr clockid_t kPerThreadBit = 4;
  if (id >= 0 || RawSyscall(SYS_clock_getres, id, 0) != 0) return EINVAL;
  const auto owner = static_cast<int>(~(id >> 3));
  const bool is_own = (id & kPerThreadBit) != 0 && (owner == 0 || owner == t.slot->tid);
  return is_own ? EINVAL : ENOTSUP;
}

int ClockFor(const GuestThread& t, clockid_t id, Clock* clock) {
  switch (id) {
    case CLOCK_REALTIME:
    case CLOCK_TAI:
    case CLOCK_REALTIME_ALARM:
      *clock = Clock::kRealtime;
      return 0;
    case CLOCK_MONOTONIC:
    case CLOCK_BOOTTIME:
    case CLOCK_BOOTTIME_ALARM:
      *clock = Clock::kMonotonic;
      return 0;
    case CLOCK_PROCESS_CPUTIME_ID:
    case CLOCK_MONOTONIC_RAW:
    case CLOCK_MONOTONIC_COARSE:
    case CLOCK_REALTIME_COARSE:
      return ENOTSUP;
    case CLOCK_THREAD_CPUTIME_ID:
      return EINVAL;
    default:
      break;
  }
  return ErrorOfCpuClock(t, id);
}

// As POSIX has it: returns the error number.
int ClockNanosleep(clockid_t id, int flags, const timespec* given, timespec* remain) {
  GuestThread* t = Enter();
  if (t == nullptr) {
    return static_cast<int>(-RawSyscall(SYS_clock_nanosleep, id, flags, Arg(given), Arg(remain)));
  }
  Clock clock;
  if (const int error = ClockFor(*t, id, &clock); error != 0) return error;
  timespec request;
  if (!CopyIn(&request, given)) return EFAULT;
  if (!IsValid(request)) return EINVAL;
  const std::int64_t request_ns = ToNs(request);
  if ((flags & TIMER_ABSTIME) != 0) {
    return SleepUntil(*t, request_ns - OffsetNs(clock)) ? 0 : EINTR;
  }
  std::int64_t remaining = 0;
  const int error = SleepFor(*t, request_ns, &remaining);
  if (error == 0 || remain == nullptr) return error;
  return CopyOut(remain, ToTimespec(remaining)) ? error : EFAULT;
}

}  // namespace

TCS_EXPORT int clock_nanosleep(clockid_t id, int flags, const timespec* request, timespec* remain) {
  return ClockNanosleep(id, flags, request, remain);
}

TCS_EXPORT int __clock_nanosleep(clockid_t id, int flags, const timespec* request,
                                 timespec* remain) {
  return ClockNanosleep(id, flags, request, remain);
}

TCS_EXPORT int nanosleep(const timespec* request, timespec* remain) {
  const int error = ClockNanosleep(CLOCK_MONOTONIC, 0, request, remain);
  return error == 0 ? 0 : Fail(error);
}

TCS_EXPORT int __nanosleep(const timespec* request, timespec* remain) {
  return nanosleep(request, remain);
}

TCS_EXPORT int usleep(useconds_t us) {
  const timespec request{us / 1'000'000, static_cast<long>(us % 1'000'000) * 1000};
  return nanosleep(&request, nullptr);
}

TCS_EXPORT unsigned sleep(unsigned seconds) {
  const int saved = errno;
  const timespec request{seconds, 0};
  timespec rest{};
  if (nanosleep(&request, &rest) == 0) {
    errno = saved;
    return 0;
  }
  // Rounded as the C library does: what is left, in whole seconds, at least the half counts up.
  return static_cast<unsigned>(rest.tv_sec + (rest.tv_nsec >= 500'000'000 ? 1 : 0));
}

TCS_EXPORT int thrd_sleep(const timespec* request, timespec* remain) {
  const int error = ClockNanosleep(CLOCK_REALTIME, 0, request, remain);
  return error == 0 ? 0 : error == EINTR ? -1 : -2;
}
