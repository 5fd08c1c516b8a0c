// The calling thread's clock, and waiting on it. Every function here is async-signal-safe.
#pragma once

#include <time.h>

#include <cstdint>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/own_work.h"
#include "shm/clock_page.h"
#include "shm/time_values.h"

namespace tcs::preload {

// CLOCK_MONOTONIC and CLOCK_REALTIME are fixed offsets from the run's virtual time.
enum class Clock { kMonotonic, kRealtime };

// A reading, and the virtual time that the clock showed for it, in ns since the run's start.
struct Now {
  shm::ClockReading reading;
  std::int64_t shown_ns;
};

inline Now Show(shm::ClockPage& page, const shm::ClockReading& reading) {
  return Now{reading, shm::ShowTime(page, reading)};
}

// Takes stolen time out, and where the horizon is reached stops the thread, then reads again.
Now ReadNowSlowly(GuestThread& thread);

// Inlined into the calls that read clocks: a call and a reading passed through memory cost as much
// again as the reading itself.
inline Now ReadNow(GuestThread& thread) {
  shm::ClockPage& page = thread.slot->clock;
  if (__builtin_expect(thread.own_work_tsc != 0, 0)) TakeOutOwnWork(thread);
  const shm::ClockReading reading = shm::ReadClock(page);
  if (__builtin_expect(reading.time_ns < reading.horizon_ns && !shm::IsCheckDue(page, reading),
                       1)) {
    const Now now = Show(page, reading);
    if (__builtin_expect(now.shown_ns < reading.horizon_ns, 1)) return now;
  }
  return ReadNowSlowly(thread);
}

// Virtual time now, in ns since the run's start. Where the horizon is reached the thread is stopped
// first.
inline std::int64_t NowNs(GuestThread& thread) { return ReadNow(thread).shown_ns; }

// Charged processor time of the thread / of its process.
std::int64_t ThreadCpuNs(GuestThread& thread);
std::int64_t ProcessCpuNs(GuestThread& thread);
std::int64_t ChildrenCpuNs(const GuestThread& thread);

inline std::int64_t OffsetNs(Clock clock) {
  return clock == Clock::kMonotonic ? g_header->monotonic_offset_ns
                                    : g_header->realtime_offset_ns.load(std::memory_order_relaxed);
}

// Sleeps until `deadline_ns`; false if a signal handler ended the sleep before. The second form
// spares a reading where the caller has just made one.
bool SleepUntil(GuestThread& thread, std::int64_t deadline_ns);
// As SleepUntil, until CLOCK_REALTIME shows `date_ns`, also where the date is set meanwhile.
bool SleepUntilDate(GuestThread& thread, std::int64_t date_ns);
bool SleepUntil(GuestThread& thread, const shm::ClockReading& now, std::int64_t deadline_ns);

// `timeout_ns` from now; never for a negative one.
std::int64_t DeadlineAfter(GuestThread& thread, std::int64_t timeout_ns);

// Returns once nothing can be produced before the thread's time any more; then what a probe finds
// is what is true at that time, no more and no less.
void HoldForRead(GuestThread& thread);

// Returns once no thread can read at a time before this thread's any more.
void HoldForWrite(GuestThread& thread);
// The thread writes now. False if another thread may still read at an earlier time. The write then
// has to hold, unless it is kept from all such readers.
bool BeginWrite(GuestThread& thread);

using shm::AddSaturated;
using shm::IsValid;
using shm::kNsPerSecond;
using shm::ToNs;
using shm::ToTimespec;
using shm::ToTimeval;

}  // namespace tcs::preload
