#include "coordinator/world/instruments/bumper.h"

namespace tcs {

void Bumper::Look(int, VirtualTime, const Eyes& eyes) {
  const std::span<const int> links = touching_.links();
  states_.resize(links.size());
  eyes.links(links, states_);
  poses_.clear();
  for (const LinkState& state : states_) poses_.push_back(state.pose);
  measured_.is_touching = touching_.Touches(poses_, spec_.margin_m);
}

}  // namespace tcs
