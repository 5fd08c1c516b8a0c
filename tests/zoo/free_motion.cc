#include "tests/zoo/free_motion.h"

#include <algorithm>
#include <cmath>

namespace tcs::zoo {

RobotModel SmoothModel(RobotModel model, std::mt19937_64& random) {
  std::uniform_real_distribution<double> draw(-1, 1);
  for (Link& link : model.links) link.shapes.clear();
  for (Joint& joint : model.joints) {
    joint.mimic.reset();
    joint.friction = 0;
    joint.limits.lower = -kNoLimit;
    joint.limits.upper = kNoLimit;
    if (CoordinatesOf(joint.kind) != 1) continue;
    const double scale = joint.kind == JointKind::kPrismatic ? 0.1 : 1;
    joint.initial_position = {scale * draw(random)};
    joint.initial_velocity = {scale * draw(random)};
  }
  return model;
}

Apart ApartFrom(const std::function<double(const Joint& joint)>& position_of,
                const RobotModel& model, EngineKind engine, VirtualDuration duration) {
  WorldSpec world;
  world.gravity_mps2 = {0, 0, -9.81};
  world.models = {model};
  world.integrator.engine = engine;
  world.integrator.accuracy = 1e-9;
  if (engine == EngineKind::kMujoco) {
    world.integrator.fixed_step = VirtualDuration::Microseconds(100);
  }
  const auto dynamics = MakeDynamics(world);
  Apart apart;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (CoordinatesOf(joint.kind) != 1) continue;
    const auto index = static_cast<int>(i);
    JointState state;
    dynamics->ReadJoints(VirtualTime() + duration, {&index, 1}, {&state, 1});
    apart.most = std::max(apart.most, std::abs(state.position - position_of(joint)));
    apart.moved = std::max(apart.moved, std::abs(state.position - joint.initial_position[0]));
  }
  return apart;
}

}  // namespace tcs::zoo
