// The one place that knows all engines.
#include <fmt/format.h>

#include "simbody_bridge/engines.h"
#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/mujoco/mujoco_engine.h"
#include "simbody_bridge/ode/ode_engine.h"
#include "simbody_bridge/simbody/simbody_engine.h"
#include "simbody_bridge/simbody/tree/tree_engine.h"

namespace tcs {

std::unique_ptr<BodyEngine> MakeEngine(const WorldSpec& world,
                                       const std::vector<std::vector<int>>& islands) {
  switch (world.integrator.engine) {
    case EngineKind::kSimbody:
      return MakeSimbodyEngine(world, islands);
    case EngineKind::kOde:
      return MakeOdeEngine(world, islands);
    case EngineKind::kMujoco:
      return MakeMujocoBodies(world, islands);
  }
  throw DynamicsError("engine: unknown kind");
}

std::unique_ptr<ModelEngine> MakeModelEngine(const WorldSpec& world,
                                             const std::vector<std::vector<int>>& islands) {
  switch (world.integrator.engine) {
    case EngineKind::kSimbody:
      return MakeTreeEngine(world, islands);
    case EngineKind::kMujoco:
      return MakeMujocoModels(world, islands);
    case EngineKind::kOde:
      break;
  }
  throw DynamicsError(
      fmt::format("model '{}': the engine {} moves free bodies only, without joints and contact; "
                  "take simbody or mujoco",
                  world.models[0].name, TraitsOf(world.integrator.engine).name));
}

}  // namespace tcs
