// What one run of a thread comes to, once the thread has stopped: how far its virtual CPU has got,
// and what the thread still owes.
//
// A thread's clock counts on while the thread runs, also beyond its horizon, where timers are late;
// it never shows more than the horizon. So the virtual CPU comes to the horizon at most, and what
// was executed beyond is a debt, charged first at the next dispatch. Pure; the virtual CPU's
// nanoseconds.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tcs {

// A thread stopped this close before its horizon has reached it: the rest is credit.
inline constexpr std::int64_t kCreditNs = 20'000;
// So much a thread computes before its CPU clock is asked what of it was stolen.
inline constexpr std::int64_t kCheckAfterNs = 100'000;
// Shown too early by what was stolen unnoticed, and stopped early: no more than both.
inline constexpr std::int64_t kMostCreditNs = kCheckAfterNs + kCreditNs;

struct StoppedRun {
  std::int64_t start_ns = 0;  // the virtual CPU's progress at the dispatch
  std::int64_t horizon_ns =
      0;  // as it is now; where others need the thread early, before its start
  std::int64_t reached_ns = 0;  // by the thread's clock
  std::int64_t shown_ns = 0;    // the furthest that this clock has shown
  // When the thread began to notify. None if it did not, and of a yield, which is a system call of
  // the program's natively, too: who spins on it must get on.
  std::optional<std::int64_t> noted_ns;
  bool is_preempted = false;   // by the timer, rather than by what it asked for
  std::int64_t credit_ns = 0;  // that it had at its dispatch
};

struct Settlement {
  std::int64_t progress_ns = 0;  // of the virtual CPU: the thread's own time from now on
  std::int64_t debt_ns = 0;      // executed beyond that; negative: credit
  std::int64_t ours_ns = 0;      // counted, but neither time nor charge of the thread's
};

constexpr bool IsAtHorizon(std::int64_t now_ns, std::int64_t horizon_ns) {
  return now_ns >= horizon_ns - kCreditNs;
}

constexpr Settlement SettleRun(const StoppedRun& run) {
  Settlement result;
  // What the notification itself takes is ours: neither the thread's clock nor its charge shows it.
  if (run.noted_ns.has_value() && *run.noted_ns < run.horizon_ns) {
    const std::int64_t noted_ns = std::max(*run.noted_ns, run.start_ns);
    result.ours_ns = std::max<std::int64_t>(0, run.reached_ns - noted_ns);
  }
  const std::int64_t reached_ns = run.reached_ns - result.ours_ns;
  // What the clock has shown has happened, even where stolen time was found in it afterwards.
  result.progress_ns = std::clamp(std::max(reached_ns, run.shown_ns), run.start_ns,
                                  std::max(run.start_ns, run.horizon_ns));
  if (run.is_preempted && IsAtHorizon(result.progress_ns, run.horizon_ns)) {
    result.progress_ns = std::max(result.progress_ns, run.horizon_ns);
  }
  result.debt_ns = reached_ns - result.progress_ns;
  if (result.debt_ns < -std::max(kMostCreditNs, run.credit_ns)) result.debt_ns = 0;
  return result;
}

}  // namespace tcs
