// An activation, from its release to its end, and the causes of that time. Times are virtual
// nanoseconds; clients are numbers, in the order of AnswerBook::Open.
#pragma once

#include <cstdint>

#include "coordinator/answers/by_client.h"
#include "coordinator/trace/activation_log.h"

namespace tcs {

// The time from an activation's release to its end, in parts that do not overlap.
struct TimeParts {
  std::int64_t queued_ns = 0;    // the thread was still at earlier input
  std::int64_t away_ns = 0;      // before its start the thread slept, or waited for something else
  std::int64_t wakeup_ns = 0;    // the kernel woke it
  std::int64_t executed_ns = 0;  // the thread had the core, or computed
  ByClient cores_ns;             // the thread was ready, and that client had the core
  ByClient locks_ns;             // in its midst, for a lock that the client's thread had
  std::int64_t room_ns = 0;      // in its midst, until others had taken what was sent

  std::int64_t TotalNs() const;
};

struct Response {
  int client = 0;
  int thread = 0;  // of the run; 0: the client's first
  ReleaseCause cause = ReleaseCause::kTime;
  std::int64_t release_ns = 0, start_ns = 0, end_ns = 0;
  std::int64_t deadline_ns = 0;  // counted from the release; 0: there is none
  std::int64_t charged_ns = 0;   // for the computing of the activation
  TimeParts parts;

  std::int64_t TookNs() const { return end_ns - release_ns; }
  // The time that is in none of the parts: changing from thread to thread, say, or others'
  // computing on one of several cores.
  std::int64_t RestNs() const { return TookNs() - parts.TotalNs(); }
};

}  // namespace tcs
