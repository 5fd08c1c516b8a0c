// How a clock page is read and moved, the same on both sides of the segment.
//
// The thread's clock is base + executed + waited, where
//   executed = (tsc - base_tsc) * ns_per_tick + executed_adjust
//   waited   = waited_adjust
// Both adjustment words carry the number of the dispatch they belong to. A reader takes both words
// before and after the other fields: equal words mean that nothing was dispatched between. A writer
// moves a word by compare-and-swap: had the thread been stopped and dispatched again in between,
// the number differs and the swap fails.
//
// Everything here is async-signal-safe, takes no lock and makes no system call.
#pragma once

#include "shm/layout.h"
#include "shm/tsc.h"

namespace tcs::shm {

inline constexpr int kAdjustBits = 48;

// The most of a thread's executed time that one exchange with the coordinator may take, both ways,
// in virtual nanoseconds.
inline constexpr std::int64_t kMostExchangeNs = 50'000;
inline constexpr std::int64_t kMostAttachNs = 20'000'000;  // where a broker is made on the way

// For a caller that works on a page as it was at one instant, whatever others write there
// meanwhile.
inline void CopyPage(const ClockPage& from, ClockPage* to) {
  __builtin_memcpy(static_cast<void*>(to), static_cast<const void*>(&from), sizeof from);
}

constexpr std::int64_t AdjustValue(std::uint64_t word) {
  return static_cast<std::int64_t>(word << (64 - kAdjustBits)) >> (64 - kAdjustBits);
}
constexpr std::uint64_t PackAdjust(std::uint64_t number_source, std::int64_t value) {
  constexpr std::uint64_t kValueMask = (std::uint64_t{1} << kAdjustBits) - 1;
  return (number_source & ~kValueMask) | (static_cast<std::uint64_t>(value) & kValueMask);
}
constexpr std::uint64_t DispatchNumber(std::uint64_t word) { return word >> kAdjustBits; }

// a * q / 2^32 without overflow for any a below 2^63.
inline std::int64_t MulQ32(std::int64_t a, std::uint64_t q) {
  __extension__ using Wide = __int128;
  return static_cast<std::int64_t>((static_cast<Wide>(a) * static_cast<Wide>(q)) >> 32);
}

// The value of the virtual cycle counter when CLOCK_MONOTONIC shows `monotonic_ns`.
inline std::uint64_t CounterAt(std::int64_t monotonic_ns, std::uint64_t ticks_per_ns_q32) {
  return static_cast<std::uint64_t>(MulQ32(monotonic_ns, ticks_per_ns_q32));
}

// A consistent reading of a clock. `time_ns` is the time that the thread has truly reached: it is
// neither held back to the horizon nor kept from going below the time that was shown before.
struct ClockReading {
  std::uint64_t tsc;
  std::int64_t time_ns;
  std::int64_t cpu_ns;
  std::int64_t horizon_ns;
  std::uint64_t executed_word;
  std::uint64_t waited_word;
};

inline ClockReading ReadClock(const ClockPage& page) {
  ClockReading r;
  for (;;) {
    r.executed_word = page.executed_adjust.load(std::memory_order_acquire);
    r.waited_word = page.waited_adjust.load(std::memory_order_acquire);
    r.tsc = ReadTsc();
    const std::int64_t executed =
        MulQ32(static_cast<std::int64_t>(r.tsc - page.base_tsc), page.ns_per_tick_q32) +
        AdjustValue(r.executed_word);
    r.cpu_ns = page.base_cpu_ns + executed;
    r.time_ns = page.base_time_ns + executed + AdjustValue(r.waited_word);
    r.horizon_ns = page.horizon_ns;
    std::atomic_signal_fence(std::memory_order_acq_rel);
    if (page.executed_adjust.load(std::memory_order_relaxed) == r.executed_word &&
        page.waited_adjust.load(std::memory_order_relaxed) == r.waited_word) {
      return r;
    }
  }
}

// The reading of the clock at `tsc`, for a page that does not change meanwhile because its thread
// is stopped.
inline ClockReading ReadClockAt(const ClockPage& page, std::uint64_t tsc) {
  ClockReading r;
  r.executed_word = page.executed_adjust.load(std::memory_order_acquire);
  r.waited_word = page.waited_adjust.load(std::memory_order_acquire);
  r.tsc = tsc;
  const std::int64_t executed =
      MulQ32(static_cast<std::int64_t>(tsc - page.base_tsc), page.ns_per_tick_q32) +
      AdjustValue(r.executed_word);
  r.cpu_ns = page.base_cpu_ns + executed;
  r.time_ns = page.base_time_ns + executed + AdjustValue(r.waited_word);
  r.horizon_ns = page.horizon_ns;
  return r;
}

// True if so much time has passed since the CPU clock was last read that much of it may be stolen.
inline bool IsCheckDue(const ClockPage& page, const ClockReading& r) {
  return r.tsc - page.last_check_tsc.load(std::memory_order_relaxed) > page.check_after_ticks;
}

// How long the thread has run, including the time that was stolen meanwhile. Taking stolen time out
// of the clock does not turn this value back, so the value tells apart moments at which the clock
// shows the same time.
inline std::int64_t RunTime(const ClockPage& page, const ClockReading& r) {
  return r.cpu_ns + page.stolen_ns.load(std::memory_order_relaxed);
}

// The time that the clock shows for a reading: at most the horizon, and more than the clock showed
// before, where computing takes time. The clock may have shown more than the thread has computed: a
// preemption came a little early, or time that the clock had shown was found to be stolen. Until
// the thread has made up for that, its clock goes at half its rate: a clock that stood still would
// show the same time before work and after it.
inline std::int64_t ShownTime(const ClockPage& page, const ClockReading& r) {
  const std::int64_t time = r.time_ns < r.horizon_ns ? r.time_ns : r.horizon_ns;
  const std::int64_t last = page.last_shown_ns.load(std::memory_order_relaxed);
  if (time > last) return time;
  if (page.ns_per_tick_q32 == 0 || last >= r.horizon_ns) return last;
  constexpr std::int64_t kLeast = 1, kMost = std::int64_t{1} << 32;  // no thread is so far behind
  const std::int64_t last_cpu = page.last_shown_cpu_ns.load(std::memory_order_relaxed);
  const auto computed = static_cast<std::uint64_t>(r.cpu_ns) - static_cast<std::uint64_t>(last_cpu);
  const std::int64_t half = static_cast<std::int64_t>(computed) / 2;
  const std::int64_t since = half < kLeast ? kLeast : half > kMost ? kMost : half;
  return since < r.horizon_ns - last ? last + since : r.horizon_ns;
}

// Remembers what the clock shows for a reading.
inline std::int64_t ShowTime(ClockPage& page, const ClockReading& r) {
  const std::int64_t shown = ShownTime(page, r);
  page.last_shown_cpu_ns.store(r.cpu_ns, std::memory_order_relaxed);
  page.last_shown_ns.store(shown, std::memory_order_relaxed);
  return shown;
}

// The thread's charge is `cpu_ns`, less than it seemed. What the thread computes from now on moves
// its clock on, even if the clock is behind the time that it has shown.
inline void FollowCharge(ClockPage& page, std::int64_t cpu_ns) {
  if (page.last_shown_cpu_ns.load(std::memory_order_relaxed) > cpu_ns)
    page.last_shown_cpu_ns.store(cpu_ns, std::memory_order_relaxed);
}

// Charged processor time according to the thread's own CPU clock, which the use of the processor by
// other threads does not move.
inline std::int64_t CpuTimeFromHostClock(const ClockPage& page, std::int64_t host_cpu_ns) {
  return MulQ32(host_cpu_ns - page.host_cpu_origin_ns, page.ns_per_host_ns_q32);
}

// Takes stolen time out of the clock: time that the TSC counted and the CPU clock did not
// (negative: time that the TSC missed). `host_cpu_ns` must have been read after `r`. False if the
// thread was dispatched anew since `r`: the caller reads again.
inline bool RemoveStolen(ClockPage& page, const ClockReading& r, std::int64_t host_cpu_ns) {
  const std::int64_t stolen = r.cpu_ns - CpuTimeFromHostClock(page, host_cpu_ns);
  std::uint64_t expected = r.executed_word;
  const std::uint64_t desired = PackAdjust(r.executed_word, AdjustValue(r.executed_word) - stolen);
  if (!page.executed_adjust.compare_exchange_strong(expected, desired)) return false;
  page.last_check_tsc.store(r.tsc, std::memory_order_relaxed);
  FollowCharge(page, r.cpu_ns - stolen);
  if (stolen > 0) page.stolen_ns.fetch_add(stolen, std::memory_order_relaxed);
  return true;
}

// Takes out time that the TSC and the CPU clock have both counted and that the thread has not had.
// The thread is stopped.
inline void RemoveUnaccounted(ClockPage& page, const ClockReading& r, std::int64_t host_ns) {
  const std::int64_t stolen = MulQ32(host_ns, page.ns_per_host_ns_q32);
  std::uint64_t expected = r.executed_word;
  const std::uint64_t desired = PackAdjust(r.executed_word, AdjustValue(r.executed_word) - stolen);
  if (!page.executed_adjust.compare_exchange_strong(expected, desired)) return;
  page.host_cpu_origin_ns += host_ns;
  FollowCharge(page, r.cpu_ns - stolen);
  page.last_check_tsc.store(r.tsc, std::memory_order_relaxed);
  page.stolen_ns.fetch_add(stolen, std::memory_order_relaxed);
}

// The host's nanoseconds for `ns` of the clock's.
inline std::int64_t HostNsOf(const ClockPage& page, std::int64_t ns) {
  return static_cast<std::int64_t>((static_cast<std::uint64_t>(ns) << 32) /
                                   page.ns_per_host_ns_q32);
}

// `ns` by the host's clock or by the robot's: whichever is longer. The work of tcs takes as long on
// a slow computer as on a fast one.
inline std::int64_t OnEither(const ClockPage& page, std::int64_t ns) {
  const std::int64_t on_robot = MulQ32(ns, page.ns_per_host_ns_q32);
  return on_robot > ns ? on_robot : ns;
}

// Takes out the last `ns` before the reading. The exchange with the coordinator took them, so they
// are neither time nor charge of the thread. Nothing is taken out if `ns` is more than `most_ns`: a
// handler has run, or other threads have. `most_ns` is OnEither.
inline void TakeOut(ClockPage& page, const ClockReading& r, std::int64_t ns, std::int64_t most_ns) {
  if (page.ns_per_tick_q32 == 0 || ns <= 0 || ns > OnEither(page, most_ns)) return;
  std::uint64_t expected = r.executed_word;
  const std::uint64_t desired = PackAdjust(r.executed_word, AdjustValue(r.executed_word) - ns);
  if (!page.executed_adjust.compare_exchange_strong(expected, desired)) return;
  page.host_cpu_origin_ns += HostNsOf(page, ns);
}

// Where others share the processor as ordinary tasks, the thread's clock goes on when the thread
// leaves its gate, from where its charge was `cpu_ns`. The time that its CPU clock has counted
// since is the way to the gate and out of it, and is taken out as by TakeOut. At the reading the
// CPU clock says `host_cpu_ns`.
inline void LeaveGate(ClockPage& page, const ClockReading& r, std::int64_t cpu_ns,
                      std::int64_t host_cpu_ns, std::int64_t most_ns) {
  const std::int64_t counted_ns = CpuTimeFromHostClock(page, host_cpu_ns) - cpu_ns;
  const bool is_ours = counted_ns > 0 && counted_ns <= OnEither(page, most_ns);
  const std::int64_t wrong_ns = r.cpu_ns - (is_ours ? cpu_ns : cpu_ns + counted_ns);
  std::uint64_t expected = r.executed_word;
  const std::uint64_t desired =
      PackAdjust(r.executed_word, AdjustValue(r.executed_word) - wrong_ns);
  if (!page.executed_adjust.compare_exchange_strong(expected, desired)) return;
  page.last_check_tsc.store(r.tsc, std::memory_order_relaxed);
  if (is_ours) page.host_cpu_origin_ns += HostNsOf(page, counted_ns);
}

}  // namespace tcs::shm
