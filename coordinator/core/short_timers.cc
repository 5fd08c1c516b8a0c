// Periodic timers of an interval too short to be lived through expiration by expiration. Who waits
// for such a timer is woken at its instant. But what runs out before the process has run again
// changes nothing that anybody could see but a count: until then the timer rests, and the count is
// made up at once. While the process runs it is looked at now and then, for the sake of its signal.
#include <algorithm>

#include "coordinator/core/engine.h"

namespace tcs {

namespace {

// So often, at most, a running thread is stopped for such a timer.
constexpr std::int64_t kLookNs = shm::kShortIntervalNs;

}  // namespace

bool Engine::IsShort(const Timer& timer) {
  return timer.interval_ns > 0 && timer.interval_ns < shm::kShortIntervalNs;
}

// It has just run out.
void Engine::Rest(Process& process, Timer& timer, std::int64_t now_ns) {
  timer.rests = true;
  timer.seen_ns = now_ns;
  process.has_resting_timers = true;
}

// A thread of the process has run: it may have read the timer, or handled its signal.
void Engine::EndRests(Process& process, std::int64_t now_ns) {
  process.has_resting_timers = false;
  for (auto& [id, timer] : process.timers) timer.rests = false;
  FindNextExpiry(process);
  // What has run out meanwhile is made up now, and not on a core that is still behind.
  if (process.next_expiry_ns != shm::kNeverNs) {
    process.next_expiry_ns = std::max(process.next_expiry_ns, now_ns);
  }
}

// What has run out by the time of the call is there when it returns.
void Engine::BringUpToDate(Process& owner, const Task& asking, std::int64_t id) {
  const auto found = owner.timers.find(id);
  if (found == owner.timers.end()) return;
  const Timer& timer = found->second;
  const std::int64_t now = asking.reached_ns;
  if (!IsShort(timer) || timer.kind.clock != shm::TimerClock::kTime || timer.next_ns == 0 ||
      timer.next_ns - timer.frozen_ns > now) {
    return;
  }
  const bool wrote = Expire(owner, now);
  if (!owner.timer_signals.empty()) RouteTimerSignals(owner, {now});
  if (wrote) PollEvents(0, {now});
}

// How far a thread of the process may run before its resting timers are looked at again.
std::int64_t Engine::NextLook(const Process& process) {
  std::int64_t next = shm::kNeverNs;
  if (!process.has_resting_timers) return next;
  for (const auto& [id, timer] : process.timers) {
    if (timer.rests) next = std::min(next, timer.seen_ns + kLookNs - timer.frozen_ns);
  }
  return next;
}

// The processor time until a timer on such time is to be looked at.
std::int64_t Engine::CpuTimeLeft(const Timer& timer, std::int64_t used_ns) {
  const std::int64_t due = IsShort(timer) && timer.seen_ns != 0
                               ? std::max(timer.next_ns, timer.seen_ns + kLookNs)
                               : timer.next_ns;
  return due - used_ns;
}

}  // namespace tcs
