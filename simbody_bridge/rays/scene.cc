#include "simbody_bridge/rays/scene.h"

#include <algorithm>
#include <cmath>

#include "simbody_bridge/model/rigid_tree.h"
#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

}  // namespace

Scene::Scene(const WorldSpec& world, int from) {
  for (const Shape& fixture : world.fixtures) {
    fixed_.push_back({RayTarget(fixture.geometry), fixture.pose});
    PutAt(fixture.pose, &fixed_.back());
  }
  first_.push_back(0);
  int index = 0;
  for (const RobotModel& model : world.models) {
    const int count = static_cast<int>(model.links.size());
    const RigidTree tree = MakeTree(model);
    const bool is_own = from >= index && from < index + count;
    const int own = is_own ? tree.links[static_cast<std::size_t>(from - index)].body : 0;
    for (std::size_t i = 0; i < model.links.size(); ++i, ++index) {
      if (model.links[i].shapes.empty() || (is_own && tree.links[i].body == own)) continue;
      for (const Shape& shape : model.links[i].shapes) {
        moving_.push_back({RayTarget(shape.geometry), shape.pose});
      }
      links_.push_back(index);
      first_.push_back(moving_.size());
    }
  }
}

void Scene::Place(std::span<const Pose> poses) {
  for (std::size_t link = 0; link < links_.size(); ++link) {
    for (std::size_t i = first_[link]; i < first_[link + 1]; ++i) {
      PutAt(Times(poses[link], moving_[i].in_link), &moving_[i]);
    }
  }
}

void Scene::PutAt(const Pose& pose, Placed* placed) {
  const auto [x, y, z, w] = Normalised(pose.orientation_xyzw);
  placed->axes = {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                   {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                   {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
  placed->origin_m = pose.position_m;
  placed->center_m = pose.position_m;
  const Vector& center = placed->target.center_m();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      placed->center_m[i] += placed->axes[axis][i] * center[axis];
    }
  }
}

double Scene::Cast(const Ray& ray) const {
  double nearest = kMeetsNothing;
  for (const std::vector<Placed>* all : {&fixed_, &moving_}) {
    for (const Placed& placed : *all) {
      const double radius = placed.target.radius_m();
      if (radius < kMeetsNothing) {
        Vector to;
        for (std::size_t i = 0; i < 3; ++i) to[i] = placed.center_m[i] - ray.origin_m[i];
        const double along = Dot(to, ray.direction);
        // The ball is passed, is behind, or is behind what has been met.
        if (Dot(to, to) - along * along > radius * radius) continue;
        if (along < -radius || along - radius > nearest) continue;
      }
      Vector from;
      for (std::size_t i = 0; i < 3; ++i) from[i] = ray.origin_m[i] - placed.origin_m[i];
      Ray inside;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        inside.origin_m[axis] = Dot(placed.axes[axis], from);
        inside.direction[axis] = Dot(placed.axes[axis], ray.direction);
      }
      nearest = std::min(nearest, placed.target.Meet(inside));
    }
  }
  return nearest;
}

}  // namespace tcs
