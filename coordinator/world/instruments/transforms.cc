#include "coordinator/world/instruments/transforms.h"

#include <algorithm>
#include <span>

namespace tcs {

Transforms::Transforms(const TransformsSpec& spec) {
  for (const TransformsSpec::Pair& pair : spec.pairs) {
    links_.push_back(pair.child);
    if (pair.parent >= 0) links_.push_back(pair.parent);
    measured_.transforms.push_back({pair.parent_frame, pair.child_frame, {}});
  }
  std::ranges::sort(links_);
  links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
  states_.resize(links_.size() + 1);  // the last one is the world's own
  const auto place = [this](int link) {
    if (link < 0) return links_.size();
    return static_cast<std::size_t>(std::ranges::lower_bound(links_, link) - links_.begin());
  };
  for (const TransformsSpec::Pair& pair : spec.pairs) {
    pairs_.emplace_back(place(pair.parent), place(pair.child));
  }
}

void Transforms::Look(int, VirtualTime, const Eyes& eyes) {
  eyes.links(links_, std::span(states_).first(links_.size()));
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const auto& [parent, child] = pairs_[i];
    measured_.transforms[i].pose = Times(Inverse(states_[parent].pose), states_[child].pose);
  }
}

}  // namespace tcs
