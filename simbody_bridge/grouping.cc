// Which bodies, and which models, are one island whatever happens.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "simbody_bridge/model/moving_ball.h"
#include "simbody_bridge/model_engine.h"

namespace tcs {
namespace {

// The groups of `together`, of which no index is in two, and each other index below `count` alone.
std::vector<std::vector<int>> Grouped(const std::vector<std::vector<int>>& together,
                                      std::size_t count, std::string_view what) {
  std::vector<std::vector<int>> islands = together;
  std::vector<bool> placed(count, false);
  for (const std::vector<int>& island : islands) {
    for (const int index : island) {
      if (index < 0 || static_cast<std::size_t>(index) >= count ||
          placed[static_cast<std::size_t>(index)]) {
        throw DynamicsError(fmt::format(
            "together: {} is not the index of a {} that is in no other island", index, what));
      }
      placed[static_cast<std::size_t>(index)] = true;
    }
  }
  std::erase_if(islands, [](const std::vector<int>& island) { return island.empty(); });
  for (std::size_t i = 0; i < count; ++i) {
    if (!placed[i]) islands.push_back({static_cast<int>(i)});
  }
  return islands;
}

}  // namespace

std::vector<std::vector<int>> IslandsOf(const WorldSpec& world) {
  return Grouped(world.together, world.bodies.size(), "body");
}

std::vector<std::vector<int>> ModelUnitsOf(const WorldSpec& world) {
  auto units = Grouped(world.models_together, world.models.size(), "model");
  for (std::vector<int>& unit : units) std::sort(unit.begin(), unit.end());
  return units;
}

bool CanMeet(const RobotModel& model) {
  return model.touches_models && !MovingShapesOf(model).empty();
}

}  // namespace tcs
