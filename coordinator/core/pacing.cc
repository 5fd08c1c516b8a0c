#include "coordinator/core/pacing.h"

#include <time.h>

#include <algorithm>
#include <utility>

#include "coordinator/os/host.h"
#include "coordinator/view/view_link.h"

namespace tcs {

namespace {

// What people see need not be newer; in between nothing is written to memory that others look at.
constexpr std::int64_t kTellEveryNs = 5'000'000;

}  // namespace

Pacing::Pacing(const RunOptions& options, std::int64_t end_ns,
               std::function<void(const std::string&)> notice)
    : pacer_(options.pace, options.starts_standing),
      view_(options.view),
      end_ns_(end_ns),
      notice_(std::move(notice)),
      is_on_(options.pace > 0 || options.starts_standing || options.view != nullptr) {}

void Pacing::TakeWishes(std::int64_t real_ns) {
  const auto wishes = view_->Take();
  if (!wishes) return;
  next_tell_ns_ = real_ns;
  if (wishes->step_ns > 0) {
    pacer_.StepBy(wishes->step_ns, real_ns);
  } else if (!wishes->stands) {
    pacer_.GoOn(real_ns);
  } else if (wishes->pace == pacer_.pace()) {
    pacer_.Stand(real_ns);
  }
  if (wishes->pace != pacer_.pace()) pacer_.SetPace(wishes->pace, real_ns);
}

// Nobody could let the run go on any more.
void Pacing::LookAtServer(std::int64_t real_ns) {
  if (is_orphaned_ || !view_->IsGone()) return;
  is_orphaned_ = true;
  if (notice_) {
    notice_(
        "the server of the page has ended, and nothing else could let the paused run go on, so it "
        "goes on");
  }
  pacer_.GoOn(real_ns);
}

std::int64_t Pacing::ToWait(std::int64_t next_ns) {
  const std::int64_t real_ns = HostClockNs(CLOCK_MONOTONIC);
  if (begun_real_ns_ < 0) begun_real_ns_ = real_ns;
  if (view_ != nullptr && !is_orphaned_) TakeWishes(real_ns);
  const std::int64_t wait_ns = pacer_.ToWait(next_ns, real_ns);
  if (held_since_ns_ >= 0) held_ns_ += real_ns - held_since_ns_;
  held_since_ns_ = wait_ns > 0 ? real_ns : -1;
  if (view_ != nullptr && (wait_ns > 0 || real_ns >= next_tell_ns_)) {
    next_tell_ns_ = real_ns + kTellEveryNs;
    view_->Tell({.stage = pacer_.stands() ? RunStage::kStands : RunStage::kGoesOn,
                 .now_ns = pacer_.now_ns(),
                 .end_ns = end_ns_,
                 .real_ns = real_ns - begun_real_ns_,
                 .behind_ns = pacer_.behind_ns() + pacer_.account().given_up_ns});
    if (pacer_.stands()) LookAtServer(real_ns);
  }
  return std::min(wait_ns, kLookNs);
}

PaceReport Pacing::Report() const {
  const Pacer::Account& account = pacer_.account();
  return {.pace = pacer_.pace(),
          .stands = pacer_.stands(),
          .late_ns = pacer_.behind_ns() + account.given_up_ns,
          .behind_ns = account.behind_ns,
          .most_ns = account.most_ns,
          .stood_ns = account.stood_ns};
}

}  // namespace tcs
