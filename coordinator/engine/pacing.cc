#include "coordinator/engine/pacing.h"

#include <algorithm>
#include <utility>

#include "coordinator/tasks/run_clock.h"
#include "coordinator/view/view_link.h"

namespace tcs {

namespace {

// The values that people see need not be newer; in between nothing is written to memory that others
// look at.
constexpr HostDuration kTellEvery = HostDuration::Milliseconds(5);

}  // namespace

Pacing::Pacing(const RunOptions& options, VirtualTime end,
               std::function<void(const std::string&)> notice)
    : pacer_(options.pace, options.starts_standing),
      view_(options.view),
      end_(end),
      notice_(std::move(notice)),
      is_on_(options.pace > 0 || options.starts_standing || options.view != nullptr) {}

void Pacing::TakeControlRequests(HostTime now) {
  const auto asked = view_->Take();
  if (!asked) return;
  next_tell_ = now;
  if (asked->step_ns > 0) {
    pacer_.StepBy(VirtualNs(asked->step_ns), now);
  } else if (!asked->stands) {
    pacer_.GoOn(now);
  } else if (asked->pace == pacer_.pace()) {
    pacer_.Stand(now);
  }
  if (asked->pace != pacer_.pace()) pacer_.SetPace(asked->pace, now);
}

// Without the server nothing could let the run go on any more.
void Pacing::LookAtServer(HostTime now) {
  if (is_orphaned_ || !view_->IsGone()) return;
  is_orphaned_ = true;
  if (notice_) {
    notice_(
        "the server of the page has ended, and nothing else could let the paused run go on, so it "
        "goes on");
  }
  pacer_.GoOn(now);
}

HostDuration Pacing::ToWait(VirtualTime next) {
  const HostTime now = RunClock::Now();
  if (!begun_.has_value()) begun_ = now;
  if (view_ != nullptr && !is_orphaned_) TakeControlRequests(now);
  const HostDuration wait = pacer_.ToWait(next, now);
  const bool waits = wait > HostDuration();
  if (held_since_.has_value()) held_ += now - *held_since_;
  held_since_ = waits ? std::optional(now) : std::nullopt;
  if (view_ != nullptr && (waits || now >= next_tell_)) {
    next_tell_ = now + kTellEvery;
    view_->Tell({.stage = pacer_.stands() ? RunStage::kStands : RunStage::kGoesOn,
                 .now_ns = pacer_.now().ns(),
                 .end_ns = end_.ns(),
                 .real_ns = (now - *begun_).ns(),
                 .behind_ns = (pacer_.behind() + pacer_.account().given_up).ns()});
    if (pacer_.stands()) LookAtServer(now);
  }
  return std::min(wait, kLook);
}

PaceReport Pacing::Report() const {
  const Pacer::Account& account = pacer_.account();
  return {.pace = pacer_.pace(),
          .stands = pacer_.stands(),
          .late_ns = (pacer_.behind() + account.given_up).ns(),
          .behind_ns = account.behind.ns(),
          .most_ns = account.most.ns(),
          .stood_ns = account.stood.ns()};
}

}  // namespace tcs
