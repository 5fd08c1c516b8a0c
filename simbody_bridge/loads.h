// What pushes the bodies besides gravity and walls, whichever engine moves them: the commands to
// them as they act by now, and the air.
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

  // Whether what pushes the body is the command to it, as it is, all through the step.
  bool IsConstant(const IslandStep& step, std::size_t place) const {
    return step.remainders.empty() && !step.wrenches[place].in_body_frame &&
           drags_[static_cast<std::size_t>(step.island)].empty();
  }

  // What pushes it `after_s` from the step's beginning on, when it is as `body`.
  Load At(const IslandStep& step, std::size_t place, double after_s, const BodyState& body) const;
  // The mean over that time of a body that goes on as `body`, for steps with one force for all of
  // it. What lags is exact.
  Load MeanOver(const IslandStep& step, std::size_t place, double seconds,
                const BodyState& body) const;

 private:
  Load Sum(const IslandStep& step, std::size_t place, double share_left, const BodyState& body,
           double after_s) const;

  Wind wind_;
  std::vector<std::vector<DragSpec>> drags_;  // of each island's bodies; none where no body has any
};

}  // namespace tcs
