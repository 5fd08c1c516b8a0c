// Knows which shapes of a forest could touch, and whether any of them are near each other where
// MuJoCo has them. To know that none are is cheap for a robot of a few shapes; MuJoCo sorts all
// bodies along an axis first, which takes a sixth of a step of a quadrotor.
#pragma once

#include <mujoco/mujoco.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "simbody_bridge/model/forest.h"

namespace tcs {

class ShapePairs {
 public:
  ShapePairs() = default;
  // `shapes` are the forest's shapes that MuJoCo's geoms are.
  ShapePairs(const Forest& forest, std::span<const std::size_t> shapes, const mjModel& model);

  // Whether no two shapes touch, for certain, where the geoms of `data` are. Always false where
  // there are so many pairs that MuJoCo is faster.
  bool AreApart(const mjModel& model, const mjData& data) const;

 private:
  std::vector<std::pair<int, int>> pairs_;  // of geoms; a plane or a box first
  bool are_too_many_ = false;
};

}  // namespace tcs
