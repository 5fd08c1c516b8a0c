#include "coordinator/engine/pace_keeper.h"

#include <algorithm>
#include <utility>

#include "coordinator/engine/wiring.h"
#include "coordinator/os/guardian.h"

namespace tcs {

namespace {

// While the run waits there is time to write what it did, for those who watch.
constexpr HostDuration kWorthFlushing = HostDuration::Milliseconds(2),
                       kFlushEvery = HostDuration::Milliseconds(100);

// How often threads that the kernel holds are looked at.
constexpr HostDuration kUnseenLook = HostDuration::Milliseconds(1);

// A run that stands for so long is paused, and not stepped.
constexpr HostDuration kPaused = HostDuration::Milliseconds(2000);

}  // namespace

// When something happens next, as far as that depends on nothing outside.
VirtualTime PaceKeeper::NextAct() const {
  const VirtualTime least = std::min(run_.root.Least(), run_.end);
  return all_.world_leaf.GoesOn() ? std::min(least, all_.world.NextStop()) : least;
}

void PaceKeeper::FlushForWatchers() {
  const HostTime now = RunClock::Now();
  if (!all_.pacing.IsWatched() || now < next_flush_) return;
  all_.records.Flush(true);
  next_flush_ = now + kFlushEvery;
}

bool PaceKeeper::Keep() {
  if (!all_.pacing.IsOn() || run_.IsInGrace()) return true;
  bool has_stood = false;
  for (bool has_drained = false;;) {
    const VirtualTime next = NextAct();
    if (next.IsNever()) return true;  // only from outside
    HostDuration wait = all_.pacing.ToWait(next);
    if (!all_.pacing.pacer().stands() || standing_since_ == HostTime())
      standing_since_ = RunClock::Now();
    if (!run_.is_unprivileged && RunClock::Now() - standing_since_ >= kPaused)
      all_.home_processor.Lend();
    if (wait == HostDuration()) {
      if (all_.home_processor.TakeBack(run_.options.on_notice)) return true;
      all_.pacing.WaitForProcessor();
      wait = Pacing::kLook;
    }
    if (!std::exchange(has_drained, true)) {
      // Events that are there already came before.
      all_.event_pump.Poll(EventPump::kNoWait, {run_.latest});
    } else {
      Beat();
      all_.lookout.Look();
      // The place where the run stands now is to be seen at once.
      if (all_.pacing.pacer().stands() && !std::exchange(has_stood, true)) next_flush_ = {};
      if (wait >= kWorthFlushing) FlushForWatchers();
      const bool looks = all_.waker.unseen() > 0 || run_.is_unprivileged;
      all_.event_pump.Poll(
          looks ? std::min(wait, kUnseenLook) : wait,
          {.at = std::max(run_.latest, all_.pacing.pacer().now()), .from_outside = true});
    }
    all_.unseen_threads.Poll();
    if (run_.stop.asked() || !run_.report.error.empty()) return false;
  }
}

}  // namespace tcs
