// The kernel's clocks in virtual time: what each clock shows, and what a program can use it for.
// Nothing here allocates; every function is async-signal-safe.
#pragma once

#include <errno.h>
#include <sys/types.h>
#include <time.h>

namespace tcs::shm {

enum class ClockKind {
  kNone,       // no clock, or one that only the kernel knows
  kMonotonic,  // virtual time since the uptime that the run began with
  kRealtime,   // virtual time since the date that it began with
  kProcessCpu,
  kThreadCpu,
};

struct ClockOfId {
  ClockKind kind = ClockKind::kNone;
  bool is_read_only = false;  // no thread can sleep on it or have timers
  bool is_alarm = false;      // would wake a machine that sleeps
  pid_t owner = 0;            // the process or thread whose processor time it is; 0: the caller

  constexpr bool IsOfCpu() const {
    return kind == ClockKind::kProcessCpu || kind == ClockKind::kThreadCpu;
  }
  constexpr bool IsOfTime() const {
    return kind == ClockKind::kMonotonic || kind == ClockKind::kRealtime;
  }
};

constexpr ClockOfId ClockOf(clockid_t id) {
  switch (id) {
    case CLOCK_REALTIME:
    case CLOCK_TAI:
      return {.kind = ClockKind::kRealtime};
    case CLOCK_REALTIME_COARSE:
      return {.kind = ClockKind::kRealtime, .is_read_only = true};
    case CLOCK_REALTIME_ALARM:
      return {.kind = ClockKind::kRealtime, .is_alarm = true};
    case CLOCK_MONOTONIC:
    case CLOCK_BOOTTIME:
      return {.kind = ClockKind::kMonotonic};
    case CLOCK_MONOTONIC_RAW:
    case CLOCK_MONOTONIC_COARSE:
      return {.kind = ClockKind::kMonotonic, .is_read_only = true};
    case CLOCK_BOOTTIME_ALARM:
      return {.kind = ClockKind::kMonotonic, .is_alarm = true};
    case CLOCK_PROCESS_CPUTIME_ID:
      return {.kind = ClockKind::kProcessCpu};
    case CLOCK_THREAD_CPUTIME_ID:
      return {.kind = ClockKind::kThreadCpu};
    default:
      break;
  }
  // The kernel's dynamic ids (posix-timers.h): ~owner in the upper bits, then whose and which
  // clock.
  constexpr clockid_t kPerThreadBit = 4, kDeviceBits = 3;
  if (id >= 0 || (id & kDeviceBits) == kDeviceBits) return {};
  const bool of_thread = (id & kPerThreadBit) != 0;
  return {.kind = of_thread ? ClockKind::kThreadCpu : ClockKind::kProcessCpu,
          .owner = static_cast<pid_t>(~(id >> 3))};
}

// The processor time of another process.
constexpr clockid_t CpuClockOf(pid_t pid) {
  constexpr clockid_t kScheduled = 2;  // as the kernel's scheduler counts it
  return static_cast<clockid_t>(~static_cast<unsigned>(pid) << 3) | kScheduled;
}

// The error of a sleep on the clock, as the kernel returns it for a clock that exists; 0 if the
// thread can sleep on it.
constexpr int ErrorOfSleepOn(clockid_t id, pid_t sleeper) {
  const ClockOfId clock = ClockOf(id);
  if (clock.kind == ClockKind::kNone) return EINVAL;
  if (clock.IsOfTime()) return clock.is_read_only ? EOPNOTSUPP : 0;
  if (id == CLOCK_THREAD_CPUTIME_ID || clock.kind == ClockKind::kProcessCpu) return EOPNOTSUPP;
  // No thread can sleep until it has computed.
  return clock.owner == 0 || clock.owner == sleeper ? EINVAL : EOPNOTSUPP;
}

// The error of a timer on the clock (timer_create); 0 if there is none. Computers of robots do not
// suspend.
constexpr int ErrorOfTimerOn(const ClockOfId& clock) {
  if (clock.kind == ClockKind::kNone) return EINVAL;
  return clock.is_read_only || clock.is_alarm ? EOPNOTSUPP : 0;
}

}  // namespace tcs::shm
