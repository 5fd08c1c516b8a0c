// Times as programs give and get them, in ns; and sums of times that stay at the end of all time
// (kNeverNs) instead of overflowing. Nothing here allocates; every function is async-signal-safe.
#pragma once

#include <sys/time.h>
#include <sys/timex.h>
#include <time.h>

#include <cstdint>

#include "shm/layout.h"

namespace tcs::shm {

inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;
// Further off than any run lasts, and yet a time that can be added to, and that is not for ever.
inline constexpr std::int64_t kFarNs = kNeverNs / 4;

constexpr std::int64_t AddSaturated(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  if (__builtin_add_overflow(a, b, &sum)) return b > 0 ? kNeverNs : -kNeverNs;
  return sum;
}

// `units` of so many ns each.
constexpr std::int64_t UnitsToNs(std::int64_t units, std::int64_t unit_ns) {
  std::int64_t ns = 0;
  if (__builtin_mul_overflow(units, unit_ns, &ns)) return units > 0 ? kNeverNs : -kNeverNs;
  return ns;
}

constexpr std::int64_t ToNs(const timespec& t) {
  return AddSaturated(UnitsToNs(t.tv_sec, kNsPerSecond), t.tv_nsec);
}
constexpr std::int64_t ToNs(const timeval& t) {
  return AddSaturated(UnitsToNs(t.tv_sec, kNsPerSecond), UnitsToNs(t.tv_usec, 1'000));
}

// The nanoseconds are never negative.
constexpr timespec ToTimespec(std::int64_t ns) {
  timespec t{ns / kNsPerSecond, ns % kNsPerSecond};
  if (t.tv_nsec < 0) {
    t.tv_nsec += kNsPerSecond;
    --t.tv_sec;
  }
  return t;
}
constexpr timeval ToTimeval(std::int64_t ns) {
  const timespec t = ToTimespec(ns);
  return timeval{t.tv_sec, t.tv_nsec / 1'000};
}
constexpr timeval RoundUpToTimeval(std::int64_t ns) { return ToTimeval(AddSaturated(ns, 999)); }

// Writes into `state` what adjtimex says of a clock that shows the date `date_ns`, and that nothing
// disciplines; the rest of `state` is the kernel's.
inline void ShowUndisciplined(std::int64_t date_ns, timex* state) {
  const timespec date = ToTimespec(date_ns);
  state->time =
      timeval{date.tv_sec, (state->status & STA_NANO) != 0 ? date.tv_nsec : date.tv_nsec / 1'000};
  state->freq = state->offset = 0;
}

// True where the kernel takes such a value for valid.
constexpr bool IsValid(const timespec& t) {
  return t.tv_sec >= 0 && t.tv_nsec >= 0 && t.tv_nsec < kNsPerSecond;
}
constexpr bool IsValid(const timeval& t) {
  return t.tv_sec >= 0 && t.tv_usec >= 0 && t.tv_usec < 1'000'000;
}
constexpr bool IsValid(const itimerspec& t) {
  return IsValid(t.it_value) && IsValid(t.it_interval);
}
constexpr bool IsValid(const itimerval& t) { return IsValid(t.it_value) && IsValid(t.it_interval); }

// A timeout of poll and its like; negative: for ever.
constexpr std::int64_t MillisecondsToNs(int ms) {
  return ms < 0 ? -1 : std::int64_t{ms} * 1'000'000;
}

// When a timer that is set to `value_ns` runs out first, on its clock, which shows `now_ns`; 0: the
// timer is not armed. Absolute values are of a clock that shows `offset_ns` more.
constexpr std::int64_t FirstExpiry(std::int64_t value_ns, bool is_absolute, std::int64_t now_ns,
                                   std::int64_t offset_ns) {
  if (value_ns == 0) return 0;
  const std::int64_t first_ns =
      is_absolute ? AddSaturated(value_ns, -offset_ns) : AddSaturated(now_ns, value_ns);
  return first_ns > 0 ? first_ns : 1;  // long past, but armed
}

// The time until a timer runs out next, at `next_ns` (0: the timer is not armed), as programs read
// it: never 0 while the timer is armed.
constexpr std::int64_t TimeLeft(std::int64_t next_ns, std::int64_t now_ns) {
  if (next_ns == 0) return 0;
  return next_ns > now_ns ? next_ns - now_ns : 1;
}

// The seconds that alarm returns for such a time left, rounded as the kernel does: never 0 while
// the timer was armed.
constexpr std::int64_t AlarmSeconds(const timeval& left) {
  const bool up = left.tv_usec >= 500'000 || (left.tv_sec == 0 && left.tv_usec > 0);
  return left.tv_sec + (up ? 1 : 0);
}

}  // namespace tcs::shm
