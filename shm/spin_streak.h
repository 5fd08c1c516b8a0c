// A thread spins if it looks at memory again and again until another thread has changed it. Such a
// thread is known by pauses (the instruction) or yields in a row, between which it computes next to
// nothing.
//
// Pure; async-signal-safe. All times are times of the thread's own clock.
#pragma once

#include <cstdint>

namespace tcs::shm {

struct SpinStreak {
  static constexpr std::uint8_t kSpins = 8;  // a thread that has paused so often in a row spins

  std::int64_t begun_ns;      // the time of the first pause
  std::int64_t last_ns;       // the time of the last pause so far
  std::int64_t shown_ns;      // what the thread's clock had shown by then
  std::uint32_t site;         // the lower half of the address of the code that pauses
  std::uint8_t pauses;        // in a row
  std::uint8_t can_be_asked;  // 1: whether the thread spins; the signal for that has its handler
  std::uint8_t reads_clock;   // 1: the thread has read its clock in between
  // 1: when the thread was asked last, it was in a loop without pauses that does nothing but look.
  std::uint8_t in_loop;
};

// The thread pauses. True if it spins. A thread that pauses at another place waits for something
// else. `shown_ns` changes whenever the thread reads its clock.
inline bool CountPause(SpinStreak& streak, std::uint32_t site, std::int64_t now_ns,
                       std::int64_t shown_ns, std::int64_t gap_ns) {
  if (streak.pauses == 0 || site != streak.site || now_ns - streak.last_ns > gap_ns) {
    streak.begun_ns = now_ns;
    streak.site = site;
    streak.pauses = 0;
    streak.reads_clock = 0;
  } else if (shown_ns != streak.shown_ns) {
    streak.reads_clock = 1;
  }
  streak.last_ns = now_ns;
  streak.shown_ns = shown_ns;
  if (streak.pauses < SpinStreak::kSpins) ++streak.pauses;
  return streak.pauses == SpinStreak::kSpins;
}

// A turn of the thread has ended while it span: time may have passed that the thread has not
// computed. The thread is seen to go on once it has paused twice.
inline void GoOnSpinning(SpinStreak& streak, std::int64_t now_ns, std::int64_t shown_ns) {
  streak.last_ns = now_ns;
  streak.shown_ns = shown_ns;
  streak.pauses = SpinStreak::kSpins - 2;
}

// Whether a thread that has stopped at `now_ns` spins; or, with `least` pauses, may have begun to.
inline bool IsSpinning(const SpinStreak& streak, std::int64_t now_ns, std::int64_t gap_ns,
                       std::uint8_t least = SpinStreak::kSpins) {
  return streak.pauses >= least && now_ns - streak.last_ns <= gap_ns;
}

}  // namespace tcs::shm
