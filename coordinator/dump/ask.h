// Asks a running coordinator for its state (state_page.h), from another process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/dump/find_run.h"
#include "coordinator/dump/state_page.h"

namespace tcs {

// The activity of the coordinator, as it has noted it, and as the kernel sees it. Times are the
// host's, in nanoseconds.
struct CoordinatorState {
  Doing doing = Doing::kPrepares;
  std::int64_t since_ns = 0;  // so long before the question
  int host_cpu = -1;
  pid_t dispatched_tid = 0;  // the last; 0: none yet
  std::int64_t dispatched_since_ns = 0;
  std::int64_t virtual_ns = 0;  // of that dispatch; virtual
  std::uint64_t dispatches = 0;
};

struct StateAnswer {
  std::optional<std::string> text;  // JSON; none: no answer in time
  std::string error;                // one sentence, where no coordinator could be asked
  CoordinatorState coordinator;     // at the question
  std::int64_t waited_ns = 0;       // real, until the answer or the end of waiting,
  std::int64_t computed_ns = 0;     // and the coordinator's processor time meanwhile
};

// Waits at most so long, of real time, for an answer. Only one process asks a run at a time: others
// wait for it, at most twice as long.
[[nodiscard]] StateAnswer AskForState(const FoundRun& run, std::int64_t within_ns);

}  // namespace tcs
