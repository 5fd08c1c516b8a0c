// The calling thread's clock, and waiting on it. All of it is async-signal-safe.
#pragma once

#include <time.h>

#include <cstdint>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "shm/clock_page.h"

namespace tcs::preload {

// CLOCK_MONOTONIC and CLOCK_REALTIME are fixed offsets from the run's virtual time.
enum class Clock { kMonotonic, kRealtime };

// Virtual time now, in ns since the run's start. Where the horizon is reached it stops the thread
// first.
std::int64_t NowNs(GuestThread& thread);

// Charged processor time of the thread / of its process.
std::int64_t ThreadCpuNs(GuestThread& thread);
std::int64_t ProcessCpuNs(GuestThread& thread);
std::int64_t ChildrenCpuNs(const GuestThread& thread);

inline std::int64_t OffsetNs(Clock clock) {
  return clock == Clock::kMonotonic ? g_header->monotonic_offset_ns : g_header->realtime_offset_ns;
}

// Sleeps until `deadline_ns`; false if a signal handler ended the sleep before.
bool SleepUntil(GuestThread& thread, std::int64_t deadline_ns);

// `timeout_ns` from now; never for a negative one.
std::int64_t DeadlineAfter(GuestThread& thread, std::int64_t timeout_ns);

// Returns once nothing can be produced before the thread's time any more; then what a probe finds
// is what is true at that time, no more and no less.
void HoldForRead(GuestThread& thread);

// Returns once nobody can read any more what is from before the thread's time.
void HoldForWrite(GuestThread& thread);

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

// Saturates instead of overflowing.
inline std::int64_t ToNs(const timespec& t) {
  if (t.tv_sec > shm::kNeverNs / kNsPerSecond - 1) return shm::kNeverNs;
  if (t.tv_sec < -(shm::kNeverNs / kNsPerSecond) + 1) return -shm::kNeverNs;
  return t.tv_sec * kNsPerSecond + t.tv_nsec;
}
inline timespec ToTimespec(std::int64_t ns) {
  timespec t{ns / kNsPerSecond, ns % kNsPerSecond};
  if (t.tv_nsec < 0) {
    t.tv_nsec += kNsPerSecond;
    --t.tv_sec;
  }
  return t;
}
inline timeval ToTimeval(std::int64_t ns) {
  const timespec t = ToTimespec(ns);
  return timeval{t.tv_sec, t.tv_nsec / 1000};
}
inline std::int64_t ToNs(const timeval& t) { return ToNs(timespec{t.tv_sec, t.tv_usec * 1000}); }
inline bool IsValid(const timespec& t) {
  return t.tv_sec >= 0 && t.tv_nsec >= 0 && t.tv_nsec < kNsPerSecond;
}
inline std::int64_t AddSaturated(std::int64_t a, std::int64_t b) {
  std::int64_t sum;
  if (__builtin_add_overflow(a, b, &sum)) return b > 0 ? shm::kNeverNs : -shm::kNeverNs;
  return sum;
}

}  // namespace tcs::preload
