// The bodies of a forest that push each other through their joints: bodies of one tree, and bodies
// whose joints mimic each other. A link that is fixed to the world parts trees: the fingers of a
// hand that is held are apart.
#pragma once

#include <cstddef>
#include <vector>

#include "simbody_bridge/model/forest.h"

namespace tcs {

// Bodies by group, each in the forest's order, and groups in the order of their first bodies.
std::vector<std::vector<std::size_t>> JointGroupsOf(const Forest& forest);

// Whether a joint of the forest has damping or friction of its own.
bool HasDampingOrFriction(const Forest& forest);

// The damping and the friction of a body's speeds.
double DampingOf(const Forest& forest, std::size_t body);
double FrictionOf(const Forest& forest, std::size_t body);

// The joint that a body's speeds are those of; nullptr where it is the base of a model.
inline const Joint* JointOfBody(const Forest& forest, std::size_t body) {
  const int joint = forest.bodies[body].joint;
  return joint < 0 ? nullptr : forest.joints[static_cast<std::size_t>(joint)].joint;
}

}  // namespace tcs
