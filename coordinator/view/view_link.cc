#include "coordinator/view/view_link.h"

#include <poll.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tcs {

namespace {

constexpr int kMostTurns = 100;
constexpr int kTurnMs = 10;
// The link takes nothing from the server that a run could not do.
constexpr double kMostPace = 1000;

}  // namespace

ViewLink::ViewLink(ControlPage* page, UniqueFd server, std::string url)
    : page_(page), server_(std::move(server)), url_(std::move(url)) {}

ViewLink::~ViewLink() { munmap(page_, sizeof *page_); }

void ViewLink::Begin(double pace, bool stands) {
  page_->pace.store(pace);
  page_->stands.store(stands ? 1 : 0);
}

std::optional<ViewLink::ControlRequests> ViewLink::Take() {
  const std::uint32_t asked = page_->asked.load(std::memory_order_acquire);
  if (asked == asked_) return {};
  asked_ = asked;
  const double pace = page_->pace.load();
  const std::int64_t stepped_ns = page_->stepped_ns.load();
  ControlRequests requests{.pace = std::isfinite(pace) ? std::clamp(pace, 0.0, kMostPace) : 0,
                           .stands = page_->stands.load() != 0,
                           .step_ns = std::max<std::int64_t>(0, stepped_ns - stepped_ns_)};
  stepped_ns_ = std::max(stepped_ns_, stepped_ns);
  return requests;
}

void ViewLink::Tell(const Status& status) {
  page_->now_ns.store(status.now_ns, std::memory_order_relaxed);
  page_->end_ns.store(status.end_ns, std::memory_order_relaxed);
  page_->real_ns.store(status.real_ns, std::memory_order_relaxed);
  page_->behind_ns.store(status.behind_ns, std::memory_order_relaxed);
  page_->taken.store(asked_, std::memory_order_relaxed);
  page_->stage.store(status.stage, std::memory_order_release);
}

bool ViewLink::IsGone() const {
  pollfd server{server_.get(), POLLIN, 0};
  return poll(&server, 1, 0) != 0;
}

void ViewLink::Conclude(std::int64_t now_ns) {
  page_->now_ns.store(now_ns);
  page_->stage.store(RunStage::kEnded);
  for (int turn = 0; turn < kMostTurns && page_->has_told.load() == 0; ++turn) {
    pollfd server{server_.get(), POLLIN, 0};
    if (poll(&server, 1, kTurnMs) != 0) return;
  }
}

}  // namespace tcs
