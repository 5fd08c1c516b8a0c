// Virtual time keeps to real time while something from outside of the run is waited for
// (calls/outside_waits.h).
#include <algorithm>

#include "coordinator/core/engine.h"
#include "coordinator/os/guardian.h"

namespace tcs {

namespace {

// There may be somebody to stop the run, or something to be said, meanwhile.
constexpr HostDuration kLook = HostDuration::Milliseconds(20);

}  // namespace

// Its leaf stands where the earliest of what may come is seen.
void Engine::ShowOutside() {
  shows_outside_ = outside_.IsAwaited();
  run_.root.Update(outside_leaf_, VirtualTime(), outside_.Due(RunningTime()));
}

// What was hidden may be no more.
void Engine::LookAgainAtHidden() {
  for (Task& task : run_.table.tasks()) descriptors_.LookAgain(task);
}

// Nothing is before what comes from outside next: it is shown, or waited for in real time. False
// where somebody else acts first.
bool Engine::StepOutside() {
  if (!outside_.IsAwaited()) {
    if (shows_outside_) ShowOutside();
    return false;
  }
  ShowOutside();
  const VirtualTime least = run_.root.Least();
  if (run_.root.First() != outside_leaf_ || least >= run_.end) return false;
  Beat();
  const HostTime now = RunningTime();
  const VirtualTime at = outside_.At(now);
  run_.latest = std::max(run_.latest, std::min(at, least));
  if (outside_.Show(least, now)) {
    ShowOutside();
    LookAgainAtHidden();
    PollEvents(kNoWait, {.at = least, .from_outside = true});
    return true;
  }
  LookAround();
  VirtualTime until = std::min(run_.root.NextInput(outside_leaf_), run_.end);
  if (WorldGoesOn()) until = std::min(until, world_.NextStop());
  const HostDuration wait = run_.IsFixed() ? kLook : outside_.RealTimeUntil(until, now);
  awaits_outside_ = true;
  PollEvents(std::clamp(wait, HostNs(1), kLook), {.at = at, .from_outside = true});
  awaits_outside_ = false;
  PollUnseen();
  return true;
}

// While it is waited for, what comes does so at the virtual time that the real one stands for.
Moment Engine::WhenItCame(Moment moment) {
  if (!awaits_outside_ || run_.turn.lasts() || !outside_.IsAwaited()) return moment;
  const VirtualTime until = run_.root.NextInput(outside_leaf_);
  moment.at = std::max(moment.at, std::min(outside_.At(RunningTime()), until));
  return moment;
}

}  // namespace tcs
