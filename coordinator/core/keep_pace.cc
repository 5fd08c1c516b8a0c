// The run is held back, in real time, before it acts.
#include <algorithm>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"

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

// When something happens next, as far as that depends on nobody outside.
VirtualTime Engine::NextAct() const {
  const VirtualTime least = std::min(run_.root.Least(), run_.end);
  return WorldGoesOn() ? std::min(least, world_.NextStop()) : least;
}

// The host's, without what the run was held back by: nobody is to be taken for standing still who
// was held.
HostTime Engine::RunningTime() const { return RunClock::Now() - pacing_.held(); }

void Engine::FlushForWatchers() {
  const HostTime now = RunClock::Now();
  if (!pacing_.IsWatched() || now < next_flush_) return;
  records_.Flush(true);
  next_flush_ = now + kFlushEvery;
}

// Others may have the processor of a run that is paused. What this one does meanwhile, for those
// who watch it, is next to nothing.
void Engine::LendProcessor() {
  if (lent_.has_value() || run_.gates_only || RunClock::Now() - standing_since_ < kPaused) return;
  lent_.emplace(claim_);
}

bool Engine::HasProcessor() {
  if (!lent_.has_value()) return true;
  const bool is_first = !std::exchange(asks_for_processor_, true);
  if (lent_->TakeBack()) {
    lent_.reset();
    asks_for_processor_ = false;
    return true;
  }
  if (is_first && run_.options.on_notice) {
    run_.options.on_notice(lent_->WhoHasIt() +
                           "; the run was paused, and goes on when it has its processor again");
  }
  return false;
}

// Until the run may act; false if it is to end instead. What comes from outside meanwhile happens
// at the time that the wall clock stands for. Of the programs nobody runs, so nothing else happens.
bool Engine::KeepPace() {
  if (!pacing_.IsOn() || run_.IsInGrace()) return true;
  bool has_stood = false;
  for (bool has_drained = false;;) {
    const VirtualTime next = NextAct();
    if (next.IsNever()) return true;  // only from outside
    HostDuration wait = pacing_.ToWait(next);
    if (!pacing_.pacer().stands() || standing_since_ == HostTime())
      standing_since_ = RunClock::Now();
    LendProcessor();
    if (wait == HostDuration()) {
      if (HasProcessor()) return true;
      wait = Pacing::kLook;
    }
    if (!std::exchange(has_drained, true)) {
      // What is there already came before.
      PollEvents(kNoWait, {run_.latest});
    } else {
      Beat();
      LookAround();
      // Where it stands now is to be seen at once.
      if (pacing_.pacer().stands() && !std::exchange(has_stood, true)) next_flush_ = {};
      if (wait >= kWorthFlushing) FlushForWatchers();
      const bool looks = waker_.unseen() > 0 || run_.gates_only;
      PollEvents(looks ? std::min(wait, kUnseenLook) : wait,
                 {.at = std::max(run_.latest, pacing_.pacer().now()), .from_outside = true});
    }
    PollUnseen();
    if (run_.stop.asked() || !run_.report.error.empty()) return false;
  }
}

}  // namespace tcs
