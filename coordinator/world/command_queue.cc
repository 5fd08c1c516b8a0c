#include "coordinator/world/command_queue.h"

#include <algorithm>
#include <utility>

namespace tcs {

void CommandQueue::Add(std::size_t channel, VirtualTime sent, What what) {
  const auto later = std::ranges::upper_bound(kept_, sent, {}, &Sent::at);
  kept_.insert(later, {sent, channel, std::move(what)});
}

bool CommandQueue::PassOn(VirtualTime until, const std::function<void(VirtualTime)>& before) {
  const auto end = std::ranges::upper_bound(kept_, until, {}, &Sent::at);
  for (auto sent = kept_.begin(); sent != end; ++sent) {
    before(sent->at);
    std::visit([&](const auto& what) { to_.Take(sent->channel, sent->at, what); }, sent->what);
  }
  const bool had_any = end != kept_.begin();
  kept_.erase(kept_.begin(), end);
  return had_any;
}

}  // namespace tcs
