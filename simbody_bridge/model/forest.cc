#include "simbody_bridge/model/forest.h"

namespace tcs {
namespace {

int Shifted(int index, std::size_t by) { return index < 0 ? index : index + static_cast<int>(by); }

void Plant(const RobotModel& model, int index, Forest* forest) {
  RigidTree tree = MakeTree(model);
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
      forest->shapes.push_back({&shape, link.body, Times(link.pose, shape.pose), index});
    }
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const int leader = joint.mimic.has_value() ? Shifted(joint.mimic->joint, joints) : -1;
    forest->joints.push_back({&joint, Shifted(tree.body_of_joint[i], bodies), leader});
  }
  forest->has_self_collision.push_back(model.has_self_collision);
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
  Forest forest;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    Plant(models[static_cast<std::size_t>(indices[i])], static_cast<int>(i), &forest);
  }
  AddFixtures(fixtures, &forest);
  return forest;
}

void AddFixtures(std::span<const Shape> fixtures, Forest* forest) {
  for (const Shape& fixture : fixtures) {
    forest->shapes.push_back({&fixture, kWorldBody, Times(Pose{}, fixture.pose), -1});
  }
}

bool MayTouch(const Forest& forest, const ForestShape& a, const ForestShape& b) {
  if (a.body == b.body) return false;
  if (a.model != b.model) return true;
  return forest.has_self_collision[static_cast<std::size_t>(a.model)] &&
         !AreJoined(forest, a.body, b.body);
}

}  // namespace tcs
