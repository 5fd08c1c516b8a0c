// The run is held back, in real time, before it acts.
#include <algorithm>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"

namespace tcs {

namespace {

// While the run waits there is time to write what it did, for those who watch.
constexpr std::int64_t kWorthFlushingNs = 2'000'000, kFlushEveryNs = 100'000'000;
// How often threads that the kernel holds are looked at.
constexpr std::int64_t kUnseenLookNs = 1'000'000;

}  // namespace

// When something happens next, as far as that depends on nobody outside.
std::int64_t Engine::NextActNs() const {
  const std::int64_t least_ns = std::min(run_.root.Least(), run_.end_ns);
  return WorldGoesOn() ? std::min(least_ns, world_.NextStopNs()) : least_ns;
}

// The host's, without what the run was held back by: nobody is to be taken for standing still who
// was held.
std::int64_t Engine::RunningNs() const { return HostClockNs(CLOCK_MONOTONIC) - pacing_.held_ns(); }

void Engine::FlushForWatchers() {
  const std::int64_t now_ns = HostClockNs(CLOCK_MONOTONIC);
  if (!pacing_.IsWatched() || now_ns < next_flush_ns_) return;
  records_.Flush();
  next_flush_ns_ = now_ns + kFlushEveryNs;
}

// Until the run may act; false if it is to end instead. What comes from outside meanwhile happens
// at the time that the wall clock stands for. Of the programs nobody runs, so nothing else happens.
bool Engine::KeepPace() {
  if (!pacing_.IsOn() || run_.IsInGrace()) return true;
  bool has_stood = false;
  for (bool has_drained = false;;) {
    const std::int64_t next_ns = NextActNs();
    if (next_ns == shm::kNeverNs) return true;  // only from outside
    const std::int64_t wait_ns = pacing_.ToWait(next_ns);
    if (wait_ns == 0) return true;
    if (!std::exchange(has_drained, true)) {
      // What is there already came before.
      PollEvents(0, {run_.latest_ns});
    } else {
      Beat();
      LookAround();
      // Where it stands now is to be seen at once.
      if (pacing_.pacer().stands() && !std::exchange(has_stood, true)) next_flush_ns_ = 0;
      if (wait_ns >= kWorthFlushingNs) FlushForWatchers();
      const bool looks = waker_.unseen() > 0 || run_.gates_only;
      PollEvents(looks ? std::min(wait_ns, kUnseenLookNs) : wait_ns,
                 {.ns = std::max(run_.latest_ns, pacing_.pacer().now_ns()), .from_outside = true});
    }
    PollUnseen();
    if (run_.stop.asked() || !run_.report.error.empty()) return false;
  }
}

}  // namespace tcs
