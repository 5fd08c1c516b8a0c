#include "coordinator/calls/syscall_times.h"

#include <errno.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timex.h>
#include <time.h>

#include <algorithm>

#include "coordinator/tasks/client_values.h"
#include "shm/clock_ids.h"

namespace tcs {

namespace {

constexpr int kTimerAbsolute = 1;  // TIMER_ABSTIME

}  // namespace

std::int64_t SyscallTimes::ReadClock(const Task& task, const TrappedCall& call) const {
  const std::int64_t now = OwnNow(task).ns();
  const std::int64_t real = now + run_.OffsetOf(true);
  if (call.number == SYS_gettimeofday) {
    constexpr struct timezone kNone {};
    const bool has_time = call.args[0] == 0 || Write(task, call.args[0], shm::ToTimeval(real));
    return has_time && (call.args[1] == 0 || Write(task, call.args[1], kNone)) ? 0 : -EFAULT;
  }
  if (call.number == SYS_time) {
    const time_t seconds = real / shm::kNsPerSecond;
    return call.args[0] == 0 || Write(task, call.args[0], seconds) ? seconds : -EFAULT;
  }
  const shm::ClockOfId clock = shm::ClockOf(static_cast<clockid_t>(call.args[0]));
  if (!clock.IsOfTime()) return -EINVAL;
  const std::int64_t shown = now + run_.OffsetOf(clock.kind == shm::ClockKind::kRealtime);
  return Write(task, call.args[1], ToTimespec(shown)) ? 0 : -EFAULT;
}

std::int64_t SyscallTimes::SetClock(Task& task, const TrappedCall& call) {
  if (call.number == SYS_settimeofday) {
    if (call.args[1] != 0) return -EPERM;  // the time zone is the host's
    if (call.args[0] == 0) return 0;
    timeval date{};
    if (!tcs::Read(task, call.args[0], &date)) return -EFAULT;
    if (!shm::IsValid(date)) return -EINVAL;
    return dates_.Set(task, shm::ToNs(date));
  }
  timespec date{};
  if (static_cast<clockid_t>(call.args[0]) != CLOCK_REALTIME) return -EINVAL;
  if (!tcs::Read(task, call.args[1], &date)) return -EFAULT;
  return shm::IsValid(date) ? dates_.Set(task, shm::ToNs(date)) : -EINVAL;
}

// The host's clock is read for the program: the program could change what it asks for meanwhile.
std::int64_t SyscallTimes::Adjust(const Task& task, const TrappedCall& call) const {
  timex state{};
  const std::uint64_t to = call.args[call.number == SYS_adjtimex ? 0 : 1];
  if (!tcs::Read(task, to, &state)) return -EFAULT;
  if (state.modes != 0) return -EPERM;
  const int how = adjtimex(&state);
  if (how < 0) return -errno;
  shm::ShowUndisciplined(OwnNow(task).ns() + run_.OffsetOf(true), &state);
  return Write(task, to, state) ? how : -EFAULT;
}

std::int64_t SyscallTimes::Sleep(Task& task, const TrappedCall& call) {
  const bool plain = call.number == SYS_nanosleep;
  const clockid_t clock = plain ? CLOCK_MONOTONIC : static_cast<clockid_t>(call.args[0]);
  if (const int error = shm::ErrorOfSleepOn(clock, task.tid); error != 0) return -error;
  timespec request{};
  if (!tcs::Read(task, call.args[plain ? 0 : 2], &request)) return -EFAULT;
  if (!IsValid(request)) return -EINVAL;
  const bool absolute = !plain && (call.args[1] & kTimerAbsolute) != 0;
  VirtualTime until = AtMostNever(task.reached, VirtualNs(ToTimeoutNs(request)));
  const bool is_date = absolute && shm::ClockOf(clock).kind == shm::ClockKind::kRealtime;
  if (absolute) {
    const ProgramTime own = OwnTime(ToTimeoutNs(request) - run_.OffsetOf(is_date));
    until = task.process->clock.RobotTimeOf(own);
  }
  const std::uint64_t remaining_address = absolute ? 0 : call.args[plain ? 1 : 3];
  waker_.Wait(task, {.what = awaited::Time{.remaining_address = remaining_address},
                     .deadline = std::max(until, task.reached),
                     .is_in_trapped_call = true,
                     .is_date = is_date});
  return 0;
}

}  // namespace tcs
