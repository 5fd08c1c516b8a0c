#include "coordinator/world/command_queue.h"

#include <algorithm>
#include <utility>

namespace tcs {

void CommandQueue::Add(std::size_t channel, const CommandSent& sent, What what) {
  const auto later = std::ranges::upper_bound(kept_, sent.at, {}, TimeOf);
  kept_.insert(later, {sent, channel, std::move(what)});
}

bool CommandQueue::PassOn(VirtualTime until, const std::function<void(VirtualTime)>& before) {
  const auto end = std::ranges::upper_bound(kept_, until, {}, TimeOf);
  for (auto kept = kept_.begin(); kept != end; ++kept) {
    before(kept->sent.at);
    std::visit([&](const auto& what) { to_.Take(kept->channel, kept->sent, what); }, kept->what);
  }
  const bool had_any = end != kept_.begin();
  kept_.erase(kept_.begin(), end);
  return had_any;
}

}  // namespace tcs
