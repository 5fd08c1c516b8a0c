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
#include "shm/clock_ids.h"

using namespace tcs::preload;
using tcs::shm::ClockKind;

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

// 0, or why nobody can sleep on that clock. Of the clocks that are made while a program runs only
// the kernel knows which there are.
int ErrorOfClock(const GuestThread& t, clockid_t id) {
  if (id == CLOCK_THREAD_CPUTIME_ID) return EINVAL;  // the C library's own word
  if (id >= 0) return tcs::shm::ErrorOfSleepOn(id, t.slot->tid);
  if (RawSyscall(SYS_clock_getres, id, 0) != 0) return EINVAL;
  const bool is_device = tcs::shm::ClockOf(id).kind == ClockKind::kNone;
  return is_device ? ENOTSUP : tcs::shm::ErrorOfSleepOn(id, t.slot->tid);
}

// As POSIX has it: returns the error number.
int ClockNanosleep(clockid_t id, int flags, const timespec* given, timespec* remain) {
  const Entered t;
  if (t == nullptr) {
    return static_cast<int>(-RawSyscall(SYS_clock_nanosleep, id, flags, Arg(given), Arg(remain)));
  }
  if (const int error = ErrorOfClock(*t, id); error != 0) return error;
  timespec request;
  if (!CopyIn(&request, given)) return EFAULT;
  if (!IsValid(request)) return EINVAL;
  const std::int64_t request_ns = ToNs(request);
  if ((flags & TIMER_ABSTIME) != 0) {
    const bool is_real = tcs::shm::ClockOf(id).kind == ClockKind::kRealtime;
    const bool is_over = is_real ? SleepUntilDate(*t, request_ns)
                                 : SleepUntil(*t, request_ns - OffsetNs(Clock::kMonotonic));
    return is_over ? 0 : EINTR;
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
  // Rounded as the C library does: the rest in whole seconds, where at least half a second counts
  // up.
  return static_cast<unsigned>(rest.tv_sec + (rest.tv_nsec >= 500'000'000 ? 1 : 0));
}

TCS_EXPORT int thrd_sleep(const timespec* request, timespec* remain) {
  const int error = ClockNanosleep(CLOCK_REALTIME, 0, request, remain);
  return error == 0 ? 0 : error == EINTR ? -1 : -2;
}
