// Which bodies, and which models, are one island.
#include <fmt/format.h>

#include <algorithm>

#include "simbody_bridge/model_engine.h"

namespace tcs {
namespace {

bool HasShape(const RobotModel& model) {
  return std::any_of(model.links.begin(), model.links.end(),
                     [](const Link& link) { return !link.shapes.empty(); });
}

}  // namespace

std::vector<std::vector<int>> IslandsOf(const WorldSpec& world) {
  std::vector<std::vector<int>> islands = world.together;
  std::vector<bool> placed(world.bodies.size(), false);
  for (const std::vector<int>& island : islands) {
    for (const int body : island) {
      if (body < 0 || static_cast<std::size_t>(body) >= placed.size() ||
          placed[static_cast<std::size_t>(body)]) {
        throw DynamicsError(fmt::format(
            "together: {} is not the index of a body that is in no other island", body));
      }
      placed[static_cast<std::size_t>(body)] = true;
    }
  }
  std::erase_if(islands, [](const std::vector<int>& island) { return island.empty(); });
  for (std::size_t body = 0; body < placed.size(); ++body) {
    if (!placed[body]) islands.push_back({static_cast<int>(body)});
  }
  return islands;
}

// Where models go is not known before they go there, so all that have shapes are one island.
std::vector<std::vector<int>> ModelIslandsOf(const WorldSpec& world) {
  std::vector<std::vector<int>> islands;
  std::vector<int> touching;
  for (std::size_t i = 0; i < world.models.size(); ++i) {
    const RobotModel& model = world.models[i];
    if (model.touches_models && HasShape(model)) {
      touching.push_back(static_cast<int>(i));
    } else {
      islands.push_back({static_cast<int>(i)});
    }
  }
  if (!touching.empty()) islands.push_back(touching);
  return islands;
}

}  // namespace tcs
