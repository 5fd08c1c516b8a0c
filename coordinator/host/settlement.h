// The result of one run of a thread, once the thread has stopped: how far its virtual CPU has got,
// and what the thread still owes.
//
// A thread's clock counts on while the thread runs, also beyond its horizon, where timers are late;
// but the clock never shows more than the horizon. So the virtual CPU comes to the horizon at most,
// and what the thread executed beyond is a debt, charged first at the next dispatch. Pure; all
// times are the virtual CPU's.
#pragma once

#include <algorithm>
#include <optional>

#include "shm/clock_page.h"
#include "shm/time_kinds.h"

namespace tcs {

// A thread stopped this close before its horizon has reached it: the rest is credit. In a short
// turn of a thread at which others look in short steps, the credit is a part of the turn, so that
// the thread does run. Not where the coordinator shares the thread's processor: the coordinator
// would look again and again, and keep the thread from the processor.
inline constexpr VirtualDuration kCredit = VirtualDuration::Microseconds(20);
inline constexpr std::int64_t kCreditsInTurn = 4;
// A thread computes so much before its CPU clock is asked what of it was stolen.
inline constexpr HostDuration kCheckAfter = HostDuration::Microseconds(100);
// Time shown too early because of what was stolen unnoticed, and an early stop: the credit is no
// more than both.
inline constexpr VirtualDuration kMostCredit = VirtualNs(kCheckAfter.ns()) + kCredit;

struct StoppedRun {
  VirtualTime start;    // the virtual CPU's progress at the dispatch
  VirtualTime horizon;  // as it is now; where others need the thread early, before its start
  VirtualTime reached;  // by the thread's clock
  VirtualTime shown;    // the furthest that this clock has shown
  // When the thread began to notify. Empty if the thread did not, and for a yield, which is
  // natively a system call of the program's, too: a thread that spins on a yield must get on.
  std::optional<VirtualTime> noted;
  // The part of the rest that may have been the notification itself: the thread says when the
  // notification began.
  VirtualDuration most_overhead = VirtualNs(shm::kMostExchangeNs);
  bool is_preempted = false;  // by the timer, rather than by what the thread asked for
  VirtualDuration credit;     // that the thread had at its dispatch
  bool in_steps = false;      // other threads look at what this one does in short steps
};

struct Settlement {
  VirtualTime progress;               // of the virtual CPU: the thread's own time from now on
  VirtualDuration debt;               // executed beyond that; negative: credit
  VirtualDuration exchange_overhead;  // counted, but neither time nor charge of the thread's
};

// Of a turn from `start` to `horizon`, times on one clock. `in_steps`: other threads look in short
// steps.
template <class Time>
constexpr bool IsAtHorizon(Time now, Time start, Time horizon, bool in_steps) {
  if (!in_steps) return now >= horizon - kCredit;
  const VirtualDuration part = VirtualNs((horizon - start).ns() / kCreditsInTurn);
  return now >= horizon - std::clamp(part, VirtualDuration(), kCredit);
}

constexpr Settlement SettleRun(const StoppedRun& run) {
  constexpr VirtualDuration kNone;
  Settlement result;
  // The time of the notification itself is exchange overhead: neither the thread's clock nor its
  // charge shows it. A thread that had begun to notify when an earlier turn ended still owes what
  // it had executed then.
  if (run.noted.has_value() && *run.noted < run.horizon) {
    const VirtualTime begun = run.start + std::max(kNone, -run.credit);
    result.exchange_overhead =
        std::clamp(run.reached - std::max(*run.noted, begun), kNone, run.most_overhead);
  }
  const VirtualTime reached = run.reached - result.exchange_overhead;
  // Time that the clock has shown has happened, even where stolen time was found in it afterwards.
  result.progress =
      std::clamp(std::max(reached, run.shown), run.start, std::max(run.start, run.horizon));
  if (run.is_preempted && IsAtHorizon(result.progress, run.start, run.horizon, run.in_steps)) {
    result.progress = std::max(result.progress, run.horizon);
  }
  result.debt = reached - result.progress;
  if (result.debt < -std::max(kMostCredit, run.credit)) result.debt = kNone;
  return result;
}

}  // namespace tcs
