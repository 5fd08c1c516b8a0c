// The things in a world that rays can meet: the shapes of its fixtures and of its models' links,
// where these are. The scene knows no engine: links are where it is told that they are.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/rays/ray_target.h"

namespace tcs {

class Scene {
 public:
  // A scene without the link `from` (as Dynamics numbers links) and what is fixed to it: a sensor
  // does not see its own housing.
  Scene(const WorldSpec& world, int from);

  // The links that move: Place wants to be told of each link. As Dynamics numbers links.
  std::span<const int> links() const { return links_; }
  // The poses of these links, in the world.
  void Place(std::span<const Pose> poses);

  // How far a ray in the world goes until it meets something.
  double Cast(const Ray& ray) const;

 private:
  struct Placed {
    RayTarget target;
    Pose in_link;
    // The place of the target's frame: the axes are the rows.
    std::array<std::array<double, 3>, 3> axes{};
    std::array<double, 3> origin_m{}, center_m{};
  };
  static void PutAt(const Pose& pose, Placed* placed);

  std::vector<int> links_;
  std::vector<std::size_t> first_;  // of each link's shapes among `moving_`, and their end
  std::vector<Placed> moving_, fixed_;
};

}  // namespace tcs
