#include "coordinator/world/due_links.h"

#include <algorithm>

#include "shm/check.h"

namespace tcs {

void DueLinks::Read(const Sensors& sensors, VirtualTime now, Dynamics& dynamics) {
  links_.clear();
  sensors.AddDueLinks(now, &links_);
  std::ranges::sort(links_);
  links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
  states_.resize(links_.size());
  if (!links_.empty()) dynamics.ReadLinks(dynamics.Now(), links_, states_);
}

void DueLinks::Give(std::span<const int> links, std::span<LinkState> states) const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto place = std::ranges::lower_bound(links_, links[i]);
    TCS_CHECK(place != links_.end() && *place == links[i]);
    states[i] = states_[static_cast<std::size_t>(place - links_.begin())];
  }
}

}  // namespace tcs
