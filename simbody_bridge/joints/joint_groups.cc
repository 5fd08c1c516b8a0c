#include "simbody_bridge/joints/joint_groups.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace tcs {

std::vector<std::vector<std::size_t>> JointGroupsOf(const Forest& forest) {
  std::vector<std::size_t> root(forest.bodies.size());
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&](std::size_t body) {
    while (root[body] != body) body = root[body];
    return body;
  };
  const auto join = [&](std::size_t a, std::size_t b) {
    const std::size_t of_a = root_of(a), of_b = root_of(b);
    root[std::max(of_a, of_b)] = std::min(of_a, of_b);
  };
  for (std::size_t body = 0; body < root.size(); ++body) {
    const int parent = forest.bodies[body].parent;
    if (parent != kWorldBody) join(body, static_cast<std::size_t>(parent));
  }
  for (const ForestJoint& joint : forest.joints) {
    if (joint.leader < 0) continue;
    const int leader = forest.joints[static_cast<std::size_t>(joint.leader)].body;
    if (joint.body == kWorldBody || leader == kWorldBody) continue;
    join(static_cast<std::size_t>(joint.body), static_cast<std::size_t>(leader));
  }
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t body = 0; body < root.size(); ++body) by_root[root_of(body)].push_back(body);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [first, bodies] : by_root) groups.push_back(std::move(bodies));
  return groups;
}

double DampingOf(const Forest& forest, std::size_t body) {
  const Joint* joint = JointOfBody(forest, body);
  return joint == nullptr ? 0 : joint->damping;
}

double FrictionOf(const Forest& forest, std::size_t body) {
  const Joint* joint = JointOfBody(forest, body);
  return joint == nullptr ? 0 : joint->friction;
}

bool HasDampingOrFriction(const Forest& forest) {
  for (std::size_t body = 0; body < forest.bodies.size(); ++body) {
    if (DampingOf(forest, body) > 0 || FrictionOf(forest, body) > 0) return true;
  }
  return false;
}

}  // namespace tcs
