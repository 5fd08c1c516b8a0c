#include "simbody_bridge/model/forest.h"

#include <algorithm>

namespace tcs {
namespace {

int Shifted(int index, std::size_t by) { return index < 0 ? index : index + static_cast<int>(by); }

// `first_link` is the number of the model's first link among those of all models.
void Plant(const RobotModel& model, int index, int first_link, Forest* forest) {
  RigidTree tree = MakeTree(model);
  MakePossible(&tree);
  const std::size_t bodies = forest->bodies.size(), joints = forest->joints.size();
  for (TreeBody& body : tree.bodies) {
    body.parent = Shifted(body.parent, bodies);
    body.joint = Shifted(body.joint, joints);
    forest->bodies.push_back(std::move(body));
    forest->model_of_body.push_back(index);
  }
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    TreeLink link = tree.links[i];
    link.body = Shifted(link.body, bodies);
    forest->links.push_back(link);
    for (const Shape& shape : model.links[i].shapes) {
      forest->shapes.push_back({&shape, link.body, Times(link.pose, shape.pose), index,
                                first_link + static_cast<int>(i)});
    }
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const int leader = joint.mimic.has_value() ? Shifted(joint.mimic->joint, joints) : -1;
    forest->joints.push_back({&joint, Shifted(tree.body_of_joint[i], bodies), leader});
  }
  forest->has_self_collision.push_back(model.has_self_collision);
  for (const auto& [a, b] : model.ignored_pairs) {
    forest->ignored_pairs.emplace(first_link + a, first_link + b);
  }
}

bool AreJoined(const Forest& forest, int a, int b) {
  const auto hangs_on = [&](int body, int on) {
    return body != kWorldBody && forest.bodies[static_cast<std::size_t>(body)].parent == on;
  };
  return hangs_on(a, b) || hangs_on(b, a);
}

}  // namespace

Forest MakeForest(std::span<const RobotModel> models, std::span<const int> indices,
                  std::span<const Shape> fixtures) {
  std::vector<int> first_link = {0};
  for (const RobotModel& model : models) {
    first_link.push_back(first_link.back() + static_cast<int>(model.links.size()));
  }
  Forest forest;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto model = static_cast<std::size_t>(indices[i]);
    Plant(models[model], static_cast<int>(i), first_link[model], &forest);
  }
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    forest.shapes.push_back(
        {&fixtures[i], kWorldBody, Times(Pose{}, fixtures[i].pose), -1, -1, static_cast<int>(i)});
  }
  return forest;
}

void AddFixtures(std::span<const StaticShape> shapes, Forest* forest) {
  for (const auto& [shape, link] : shapes) {
    forest->shapes.push_back({&shape, kWorldBody, Times(Pose{}, shape.pose), -1, link});
  }
}

bool MayTouch(const Forest& forest, const ForestShape& a, const ForestShape& b) {
  if (a.body == b.body) return false;
  if (a.model != b.model) return true;
  return forest.has_self_collision[static_cast<std::size_t>(a.model)] &&
         !AreJoined(forest, a.body, b.body) &&
         !forest.ignored_pairs.contains(std::minmax(a.link, b.link));
}

}  // namespace tcs
