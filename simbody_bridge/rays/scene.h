// What there is in a world for rays to meet: the shapes of its fixtures and of its models' links,
// where these are. It knows no engine: links are where it is told that they are.
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
  // Without the link `from` (as Dynamics numbers them) and what is fixed to it: a sensor does not
  // see its own housing.
  Scene(const WorldSpec& world, int from);

  // The links that move: Place wants to be told of each. As Dynamics numbers them.
  std::span<const int> links() const { return links_; }
  // Where they are, in the world.
  void Place(std::span<const Pose> poses);

  // How far a ray in the world goes until it meets something.
  double Cast(const Ray& ray) const;

 private:
  struct Placed {
    RayTarget target;
    Pose in_link;
    // Where its frame is: the axes are the rows.
    std::array<std::array<double, 3>, 3> axes{};
    std::array<double, 3> origin_m{}, center_m{};
  };
  static void PutAt(const Pose& pose, Placed* placed);

  std::vector<int> links_;
  std::vector<std::size_t> first_;  // of each link's shapes among `moving_`, and their end
  std::vector<Placed> moving_, fixed_;
};

}  // namespace tcs
