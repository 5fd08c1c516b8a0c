#include "coordinator/engine/outside_leaf.h"

#include <algorithm>

#include "coordinator/engine/wiring.h"
#include "coordinator/os/guardian.h"

namespace tcs {

namespace {

// Somebody may stop the run, or there may be something to say, meanwhile.
constexpr HostDuration kLook = HostDuration::Milliseconds(20);

}  // namespace

void OutsideLeaf::Join(int computer) { leaf_ = run_.root.AddLeaf(computer); }

void OutsideLeaf::Update() {
  is_shown_ = all_.outside.IsAwaited();
  run_.root.Update(leaf_, VirtualTime(), all_.outside.Due(all_.pacing.RunningTime()));
}

void OutsideLeaf::LookAgainAtHidden() {
  for (Task& task : run_.table.tasks()) all_.descriptors.LookAgain(task);
}

bool OutsideLeaf::Step() {
  if (!all_.outside.IsAwaited()) {
    if (is_shown_) Update();
    return false;
  }
  Update();
  const VirtualTime least = run_.root.Least();
  if (run_.root.First() != leaf_ || least >= run_.end) return false;
  Beat();
  const HostTime now = all_.pacing.RunningTime();
  const VirtualTime at = all_.outside.At(now);
  run_.latest = std::max(run_.latest, std::min(at, least));
  if (all_.outside.Show(least, now)) {
    Update();
    LookAgainAtHidden();
    all_.event_pump.Poll(EventPump::kNoWait, {.at = least, .from_outside = true});
    return true;
  }
  all_.lookout.Look();
  VirtualTime until = std::min(run_.root.NextInput(leaf_), run_.end);
  if (all_.world_leaf.GoesOn()) until = std::min(until, all_.world.NextStop());
  const HostDuration wait = run_.IsFixed() ? kLook : all_.outside.RealTimeUntil(until, now);
  awaits_ = true;
  all_.event_pump.Poll(std::clamp(wait, HostNs(1), kLook), {.at = at, .from_outside = true});
  awaits_ = false;
  all_.unseen_threads.Poll();
  return true;
}

EventTime OutsideLeaf::WhenItCame(EventTime when) const {
  if (!awaits_ || run_.turn.lasts() || !all_.outside.IsAwaited()) return when;
  const VirtualTime until = run_.root.NextInput(leaf_);
  when.at = std::max(when.at, std::min(all_.outside.At(all_.pacing.RunningTime()), until));
  return when;
}

}  // namespace tcs
