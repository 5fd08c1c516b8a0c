#include "simbody_bridge/touch/touching.h"

#include "simbody_bridge/touch/convex.h"

namespace tcs {

Touching::Touching(const WorldSpec& world, int link) : links_{link} {
  for (const Shape& fixture : world.fixtures) fixtures_.push_back(&fixture);
  int first = 0;
  for (const RobotModel& model : world.models) {
    const int end = first + static_cast<int>(model.links.size());
    if (link >= first && link < end) {
      for (const Shape& shape : model.links[static_cast<std::size_t>(link - first)].shapes) {
        own_.push_back({&shape, 0});
      }
    } else {
      for (std::size_t i = 0; i < model.links.size(); ++i) {
        if (model.links[i].shapes.empty()) continue;
        for (const Shape& shape : model.links[i].shapes) others_.push_back({&shape, links_.size()});
        links_.push_back(first + static_cast<int>(i));
      }
    }
    first = end;
  }
}

bool Touching::Touches(std::span<const Pose> poses, double margin_m) const {
  for (const Part& own : own_) {
    const PlacedConvex here(own.shape->geometry, Times(poses[0], own.shape->pose));
    for (const Shape* fixture : fixtures_) {
      const bool is_plane = std::holds_alternative<PlaneShape>(fixture->geometry);
      if (is_plane ? IsWithin(here, fixture->pose, margin_m)
                   : AreWithin(here, PlacedConvex(fixture->geometry, fixture->pose), margin_m)) {
        return true;
      }
    }
    for (const Part& other : others_) {
      const PlacedConvex there(other.shape->geometry, Times(poses[other.link], other.shape->pose));
      if (AreWithin(here, there, margin_m)) return true;
    }
  }
  return false;
}

}  // namespace tcs
