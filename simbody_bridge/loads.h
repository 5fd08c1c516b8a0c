// The loads on the bodies besides gravity and walls, whichever engine moves the bodies: the
// commands to them as they act by now, and the air.
#pragma once

#include <cstddef>
#include <vector>

#include "simbody_bridge/air.h"
#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/load.h"

namespace tcs {

class Loads {
 public:
  Loads(const WorldSpec& world, const std::vector<std::vector<int>>& islands);

  // Whether the load on the body is the command to it, as it is, all through the step.
  bool IsConstant(const IslandStep& step, std::size_t place) const {
    return step.remainders.empty() && !step.wrenches[place].in_body_frame &&
           drags_[static_cast<std::size_t>(step.island)].empty();
  }

  // The load on the body `after_s` from the step's beginning on, when its state is `body`.
  Load At(const IslandStep& step, std::size_t place, double after_s, const BodyState& body) const;
  // The mean load over `seconds` on a body that goes on as `body`, for steps with one force for all
  // of the step. Commands that lag are exact.
  Load MeanOver(const IslandStep& step, std::size_t place, double seconds,
                const BodyState& body) const;

 private:
  Load Sum(const IslandStep& step, std::size_t place, double share_left, const BodyState& body,
           double after_s) const;

  Wind wind_;
  std::vector<std::vector<DragSpec>> drags_;  // of each island's bodies; empty: no body has any
};

}  // namespace tcs
