// Time that was stolen from a thread's turn and that no clock tells of: a virtual machine that is
// paused, or whose host accounts for nothing, and a burst of interrupts are all on the CPU clock of
// the thread that they hit.
//
// The coordinator's own timer tells. The coordinator preempts the threads that it dispatches, so
// that no thread can have computed beyond the instant at which the timer was due: time that is
// counted beyond it is stolen. The theft began before that instant, and how long before is not
// known; so of the rest, too, the thread is charged no more than the longest turn that it has taken
// of late, or than what its clock has shown already. Pure; the host's nanoseconds.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tcs {

struct HostTurn {
  std::int64_t counted_ns = 0;  // by the thread's clocks, since the timer was set
  std::int64_t asked_ns = 0;    // until the timer was due
  std::int64_t usual_ns = 0;    // the longest of the thread's turns of late
  std::int64_t shown_ns = 0;    // of what is counted, as much as the thread's clock has shown
};

// Of 14,000 timers against a computing thread, on a host that accounts for stolen time, none was
// later than 0.1 ms by the thread's CPU clock but one: 0.6 ms. The kernel, too, may compute for a
// thread without giving way.
inline constexpr std::int64_t kMostTimerLatenessNs = 1'000'000;

// The part of the turn that is not the thread's; 0 where the timer came in time.
constexpr std::int64_t UnaccountedSteal(const HostTurn& turn) {
  if (turn.counted_ns <= turn.asked_ns + kMostTimerLatenessNs) return 0;
  const std::int64_t its = std::clamp(turn.usual_ns, std::int64_t{0}, turn.asked_ns);
  return turn.counted_ns - std::max(its, std::min(turn.shown_ns, turn.asked_ns));
}

}  // namespace tcs
